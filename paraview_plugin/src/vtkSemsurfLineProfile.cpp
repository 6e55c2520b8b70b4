// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfLineProfile.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <cmath>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/mesh.h"
#include "convert/table.h"
#include "convert/transform.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/core/sample_image.h"
#include "surf/mesh/height_profile.h"

vtkStandardNewMacro(vtkSemsurfLineProfile);

using namespace surf;

int vtkSemsurfLineProfile::FillInputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 2 ? "vtkPolyData" : "vtkImageData");
  if (port > 0) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSemsurfLineProfile::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                               vtkInformationVector*) {
  pv::request_whole(inputs, 3);
  return 1;
}

int vtkSemsurfLineProfile::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                       vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (!pv::is_first_piece(output)) return;
    if (this->Samples < 2 || this->Samples > 1000000)
      throw UsageError("Samples", fmt::format("{} is not in 2 to 1000000", this->Samples),
                       "Give 500 where in doubt");
    for (int i = 0; i < 3; ++i) {
      pv::need_moderate(this->Point1[i], "Point1");
      pv::need_moderate(this->Point2[i], "Point2");
    }
    const Affine to_sem = inverse(pv::to_affine(this->Transform));
    vtkImageData* const scan_image = pv::image_input(inputs, 0, "Input");
    vtkDataArray* const scan_array = pv::chosen_array(this, 0, scan_image);
    const PlacedImage scan = pv::to_placed_image(scan_image, scan_array, "Input");
    surf::Point2 from{this->Point1[0], this->Point1[1]}, to{this->Point2[0], this->Point2[1]};
    if (from == to) {
      const double middle = 0.5 * (scan.values.height() - 1);
      from = scan.place_nm(0, middle);
      to = scan.place_nm(scan.values.width() - 1, middle);
    }
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    std::vector<surf::Point2> places;
    std::vector<double> distances, x, y;
    for (int i = 0; i < this->Samples; ++i) {
      const double t = static_cast<double>(i) / (this->Samples - 1);
      places.push_back({(1 - t) * from.x + t * to.x, (1 - t) * from.y + t * to.y});
      distances.push_back(t * length);
      x.push_back(places.back().x);
      y.push_back(places.back().y);
    }
    vtkNew<vtkTable> table;
    pv::add_column(table, "distance_nm", std::move(distances));
    pv::add_column(table, "x_nm", std::move(x));
    pv::add_column(table, "y_nm", std::move(y));
    const auto add_image = [&](const PlacedImage& image, const Affine& map, const char* name) {
      std::vector<double> values;
      for (const surf::Point2 place : places) values.push_back(sample_image(image, map(place)));
      pv::add_column(table, name, std::move(values));
    };
    add_image(scan, Affine{}, "scan");
    if (vtkImageData* const sem = pv::image_input(inputs, 1, "SEM"))
      add_image(pv::to_placed_image(sem, pv::chosen_array(this, 1, sem), "SEM"), to_sem, "sem");
    if (vtkPolyData* const data = pv::surface_input(inputs, 2)) {
      const TriangleMesh mesh = pv::to_mesh(data, "Surface");
      std::vector<double> heights;
      pv::work(this,
               [&](const Watch&) { heights = height_profile(mesh, from, to, this->Samples); });
      pv::add_column(table, "surface_nm", std::move(heights));
    }
    pv::give(output, table);
  });
}
