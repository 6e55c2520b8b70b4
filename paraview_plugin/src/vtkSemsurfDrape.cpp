// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfDrape.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "attempt.h"
#include "convert/arrays.h"
#include "convert/mesh.h"
#include "convert/transform.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/core/sample_image.h"

vtkStandardNewMacro(vtkSemsurfDrape);

using namespace surf;

int vtkSemsurfDrape::FillInputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPolyData" : "vtkImageData");
  return 1;
}

namespace {

/// Pixels reach half a pixel beyond their centres: there, at the image's rim, the nearest one
/// holds.
Point2 onto_centres(const PlacedImage& image, Point2 place_nm) {
  const auto along = [](double nm, double origin_nm, double pitch_nm, int count) {
    const double at = (nm - origin_nm) / pitch_nm, last = count - 1;
    return at < -0.5 || at > last + 0.5 ? nm : origin_nm + std::clamp(at, 0.0, last) * pitch_nm;
  };
  return {along(place_nm.x, image.origin_x_nm, image.pitch_x_nm, image.values.width()),
          along(place_nm.y, image.origin_y_nm, image.pitch_y_nm, image.values.height())};
}

}  // namespace

int vtkSemsurfDrape::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                         vtkInformationVector*) {
  pv::request_whole(inputs, 2);
  return 1;
}

int vtkSemsurfDrape::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (!pv::is_first_piece(output)) return;
    const Affine to_image = inverse(pv::to_affine(this->Transform));
    vtkPolyData* const surface = pv::surface_input(inputs, 0);
    if (surface->GetNumberOfPoints() == 0)
      throw InvalidInput("Input", "it has no points", "Give a surface");
    vtkImageData* const picture = pv::image_input(inputs, 1, "Image");
    vtkDataArray* const array = pv::chosen_array(this, 0, picture);
    const PlacedImage image = pv::to_placed_image(picture, array, "Image");
    const auto count = static_cast<std::size_t>(surface->GetNumberOfPoints());
    std::vector<float> values(count), places(2 * count);
    pv::work(this, [&](const Watch& watch) {
      for (std::size_t i = 0; i < count; ++i) {
        if (i % 65536 == 0) watch.report(static_cast<double>(i), static_cast<double>(count));
        double p[3];
        surface->GetPoint(static_cast<vtkIdType>(i), p);
        if (!std::isfinite(p[0] + p[1] + p[2]))
          throw InvalidInput(
              "Input", fmt::format("point {} has no place: ({}, {}, {})", i, p[0], p[1], p[2]),
              "'Clean to Grid', 'Threshold' or 'Clip' takes such points out");
        const Point2 q = to_image({p[0], p[1]});
        values[i] = static_cast<float>(sample_image(image, onto_centres(image, q)));
        // A texture's corners are the outer edges of its pixels.
        places[2 * i] = static_cast<float>(((q.x - image.origin_x_nm) / image.pitch_x_nm + 0.5) /
                                           image.values.width());
        places[2 * i + 1] = static_cast<float>(
            ((q.y - image.origin_y_nm) / image.pitch_y_nm + 0.5) / image.values.height());
      }
    });
    vtkNew<vtkPolyData> draped;
    draped->ShallowCopy(surface);
    const char* const name = array->GetName() ? array->GetName() : "image";
    draped->GetPointData()->AddArray(pv::take_array<vtkFloatArray>(std::move(values), name));
    draped->GetPointData()->SetActiveScalars(name);
    draped->GetPointData()->SetTCoords(
        pv::take_array<vtkFloatArray>(std::move(places), "texture", 2));
    pv::give(output, draped);
  });
}
