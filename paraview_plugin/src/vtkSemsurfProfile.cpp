// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfProfile.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "attempt.h"
#include "chain.h"
#include "convert/mesh.h"
#include "labels.h"
#include "pipeline.h"
#include "profile_results.h"
#include "property_values.h"
#include "reports.h"
#include "surf/io/cache.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/workflow/profile_job.h"

vtkStandardNewMacro(vtkSemsurfProfile);

using namespace surf;

namespace {

enum Port { heights, surface, edges, residual, numbers, rows, profiles, roughness };

const pv::Labels labels{
    {"SEM image", "Input"}, {"AFM scan", "AFM"}, {"`specimen.material`", "Material"}};

/// With the image on it, to be shown in place of the heights.
Surface surface_of(const workflow::ProfileSummary& s, const PlacedImage& image) {
  Surface sheet;
  sheet.name = "profile";
  sheet.mesh = height_field_sheet(s.surface);
  const auto add = [&](const char* name, const char* unit, const Grid<double>& grid) {
    VertexScalar scalar{name, unit, {}};
    for (const double value : grid.data()) scalar.values.push_back(static_cast<float>(value));
    sheet.scalars.push_back(std::move(scalar));
  };
  add("height", "nm", s.surface.z_nm);
  add("deviation", "nm", s.deviation_nm);
  add("signal", "1", image.values);
  return sheet;
}

Grid<double> residual_of(const PlacedImage& image, const Grid<double>& fitted) {
  Grid<double> values = image.values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values.data()[i] = image.valid.includes(i) ? values.data()[i] - fitted.data()[i]
                                               : std::numeric_limits<double>::quiet_NaN();
  return values;
}

}  // namespace

int vtkSemsurfProfile::FillInputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  if (port == 0) info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  else info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSemsurfProfile::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == heights || port == residual ? "vtkImageData"
                                             : port == surface || port == edges  ? "vtkPolyData"
                                                                                 : "vtkTable");
  return 1;
}

int vtkSemsurfProfile::RequestInformation(vtkInformation*, vtkInformationVector**,
                                          vtkInformationVector* outputs) {
  for (const int port : {heights, residual})
    outputs->GetInformationObject(port)->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  for (const int port : {surface, edges, numbers, rows, profiles, roughness})
    pv::announce_pieces(outputs->GetInformationObject(port));
  return 1;
}

int vtkSemsurfProfile::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                   vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels(
        [&] {
          workflow::ProfileJob job;
          job.picture = false;
          job.cache = io::cache_folder();
          this->Values->apply(job);
          job.material = pv::chosen_material(*this->Values);
          vtkImageData* const input = pv::image_input(inputs, 0, "Input");
          job.sem.image = pv::to_placed_image(input, pv::chosen_array(this, 0, input), "Input");
          for (int k = 1; vtkImageData* const view = pv::image_input(inputs, 0, "Input", k); ++k) {
            job.views.emplace_back();
            job.views.back().image =
                pv::to_placed_image(view, pv::chosen_array(this, 0, view), "Input");
          }
          if (vtkImageData* const scan = pv::image_input(inputs, 1, "AFM"))
            job.scan = pv::to_height_field(scan, pv::chosen_array(this, 1, scan), "AFM");
          std::vector<std::string> warnings;
          std::optional<workflow::ProfileSummary> s;
          pv::work(this, [&](const Watch& watch) {
            s = workflow::run(job, pv::listen(watch, 2 * job.rounds, warnings));
          });
          pv::warn(this, warnings);
          pv::warn(this, s->reasons);

          const std::map<std::string, std::string> texts{
              {"material", job.material.name}, {"trusted", s->reasons.empty() ? "yes" : "no"}};
          const auto give_table = [&](int port, auto&& fill) {
            vtkNew<vtkTable> table;
            fill(table.Get());
            pv::add_texts(table, texts);
            pv::give(outputs->GetInformationObject(port), table);
          };
          give_table(numbers, [&](vtkTable* t) { pv::fill_numbers(t, job, *s); });
          give_table(rows, [&](vtkTable* t) { pv::fill_rows(t, *s); });
          give_table(profiles, [&](vtkTable* t) { pv::fill_profiles(t, job, *s); });
          give_table(roughness, [&](vtkTable* t) { pv::fill_roughness(t, *s); });
          pv::give(outputs->GetInformationObject(edges), pv::edge_lines(*s));
          pv::give(outputs->GetInformationObject(surface),
                   pv::to_vtk(surface_of(*s, job.sem.image)));
          const auto compared = pv::make_image_like(input);
          pv::add_values(compared, residual_of(job.sem.image, s->fitted), "residual", "1");
          pv::add_values(compared, std::move(s->fitted), "fitted", "1");
          pv::add_values(compared, job.sem.image.values, "signal", "1");
          compared->GetPointData()->SetActiveScalars("residual");
          pv::give(outputs->GetInformationObject(residual), compared);
          const auto image = pv::make_image_like(input);
          pv::add_values(image, std::move(s->deviation_nm), "deviation_nm", "nm");
          pv::add_heights(image, std::move(s->surface));
          pv::add_texts(image, texts);
          pv::add_record(image, "profile", record_of(job));
          pv::give(outputs->GetInformationObject(heights), image);
        },
        labels);
  });
}
