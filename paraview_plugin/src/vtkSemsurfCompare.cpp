// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfCompare.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "attempt.h"
#include "convert/image.h"
#include "convert/table.h"
#include "labels.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/workflow/compare_job.h"

vtkStandardNewMacro(vtkSemsurfCompare);

using namespace surf;

namespace {

/// Heights, with their standard deviations where the image has them.
workflow::MeasuredSurface measured(vtkImageData* image, vtkDataArray* heights, const char* label) {
  workflow::MeasuredSurface surface{pv::to_height_field(image, heights, label), {}};
  vtkDataArray* const deviation = image->GetPointData()->GetArray("deviation_nm");
  if (!deviation || deviation == heights) return surface;
  surface.deviation_nm = pv::to_placed_image(image, deviation, label).values;
  for (double& d : surface.deviation_nm.data())
    if (!(d >= 0)) d = 0;
  return surface;
}

/// A map of the difference, NaN where there is none.
void add_map(vtkImageData* image, const workflow::CompareSummary& s, const Grid<double>& values,
             const char* name, const char* unit) {
  Grid<double> map = values;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (!s.difference.valid.includes(i)) map.data()[i] = std::numeric_limits<double>::quiet_NaN();
  pv::add_values(image, std::move(map), name, unit);
}

void add_places(vtkTable* table, const std::vector<ChangedPlace>& places) {
  const auto add = [&](const char* name, const auto& number_of) {
    std::vector<double> values;
    for (const ChangedPlace& p : places) values.push_back(number_of(p));
    pv::add_column(table, name, std::move(values));
  };
  std::vector<int> numbers;
  for (std::size_t i = 0; i < places.size(); ++i) numbers.push_back(static_cast<int>(i) + 1);
  pv::add_column(table, "place", std::move(numbers));
  add("x_nm", [](const ChangedPlace& p) { return p.centre_nm.x; });
  add("y_nm", [](const ChangedPlace& p) { return p.centre_nm.y; });
  add("area_nm2", [](const ChangedPlace& p) { return p.area_nm2; });
  add("mean_nm", [](const ChangedPlace& p) { return p.mean; });
  add("mean_error_nm", [](const ChangedPlace& p) { return p.mean_error; });
  add("largest_nm", [](const ChangedPlace& p) { return p.largest; });
  add("volume_nm3", [](const ChangedPlace& p) { return p.volume; });
  add("volume_error_nm3", [](const ChangedPlace& p) { return p.volume_error; });
  add("deviations", [](const ChangedPlace& p) { return p.score; });
  add("probability", [](const ChangedPlace& p) { return p.probability; });
}

}  // namespace

int vtkSemsurfCompare::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

int vtkSemsurfCompare::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                   vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels([&] {
      workflow::CompareJob job;
      this->Values->apply(job.parameters);
      vtkImageData* const before = pv::image_input(inputs, 0, "Input");
      vtkImageData* const after = pv::image_input(inputs, 1, "After");
      job.before = measured(before, pv::chosen_array(this, 0, before), "Input");
      job.after = measured(after, pv::chosen_array(this, 1, after), "After");
      std::vector<std::string> warnings;
      workflow::CompareSummary s;
      pv::work(this,
               [&](const Watch& watch) { s = workflow::run(job, pv::hear(watch, warnings)); });
      if (s.verdict == workflow::CompareVerdict::not_registered)
        throw InvalidInput("After",
                           "it cannot be laid on the surface before: " +
                               (s.reasons.empty() ? std::string("they look unlike") : s.reasons[0]),
                           "Check that both show the same place, or switch Registered on");
      warnings.insert(warnings.end(), s.reasons.begin(), s.reasons.end());
      pv::warn(this, warnings);

      vtkNew<vtkTable> table;
      add_places(table, s.changes.places);
      pv::add_texts(table,
                    {{"verdict", workflow::name(s.verdict)}, {"deviation_from", s.deviation_from}});
      const auto image = pv::make_image_like(before);
      add_map(image, s, s.difference.difference, "difference", "nm");
      add_map(image, s, s.changes.deviation, "deviation", "nm");
      add_map(image, s, s.changes.probability, "probability", "1");
      Grid<double> place(s.changes.place.width(), s.changes.place.height());
      std::ranges::copy(s.changes.place.data(), place.data().begin());
      add_map(image, s, place, "place", "1");
      add_map(image, s, s.before.values, "before", "nm");
      add_map(image, s, s.after.values, "after", "nm");
      image->GetPointData()->SetActiveScalars("probability");
      pv::add_record(image, "compare", record_of(job.parameters));
      pv::give(outputs->GetInformationObject(0), image);
      pv::give(outputs->GetInformationObject(1), table);
    });
  });
}
