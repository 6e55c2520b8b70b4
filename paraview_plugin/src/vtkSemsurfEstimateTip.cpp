// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfEstimateTip.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <algorithm>
#include <utility>

#include "attempt.h"
#include "convert/table.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/workflow/tip_job.h"

vtkStandardNewMacro(vtkSemsurfEstimateTip);

using namespace surf;

namespace {

template <class Row, class Value>
std::vector<double> column_of(const std::vector<Row>& rows, const Value& value) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(value(row));
  return values;
}

void add_curve(vtkTable* table, const TipSweep& sweep) {
  const auto add = [&](const char* name, auto value) {
    pv::add_column(table, name, column_of(sweep.curve, value));
  };
  add("threshold_nm", [](const SweptTip& t) { return t.threshold_nm; });
  add("volume_nm3", [](const SweptTip& t) { return t.volume_nm3; });
  add("residual_nm", [](const SweptTip& t) { return t.residual_nm; });
  add("expected_nm", [](const SweptTip& t) { return t.expected_nm; });
  add("peaks_nm", [](const SweptTip& t) { return t.peaks_nm; });
  add("expected_peaks_nm", [](const SweptTip& t) { return t.expected_peaks_nm; });
  add("excess", [](const SweptTip& t) { return t.excess(); });
  add("consistent", [](const SweptTip& t) { return t.consistent ? 1.0 : 0.0; });
  std::vector<double> chosen(sweep.curve.size(), 0);
  chosen[sweep.chosen] = 1;
  pv::add_column(table, "chosen", std::move(chosen));
}

void add_candidates(vtkTable* table, const BestTipSummary& summary) {
  const auto add = [&](const char* name, auto value) {
    pv::add_column(table, name, column_of(summary.candidates, value));
  };
  add("threshold_nm", [](const TipCandidate& c) { return c.threshold_nm; });
  add("tolerance", [](const TipCandidate& c) { return c.tolerance; });
  add("misfit", [](const TipCandidate& c) { return c.misfit; });
  add("freedom", [](const TipCandidate& c) { return c.freedom; });
  add("risk", [](const TipCandidate& c) { return c.risk; });
}

}  // namespace

int vtkSemsurfEstimateTip::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

workflow::TipParameters vtkSemsurfEstimateTip::Parameters() const {
  workflow::TipParameters parameters;
  this->Values->apply(parameters, {"tip.answer"});
  pv::PropertyValues values = *this->Values;
  // What another answer takes says nothing.
  if (parameters.answer == workflow::TipAnswer::blind) {
    values.forget("scan.height_noise");
  } else {
    for (const char* of_blind :
         {"tip.threshold", "tip.threshold_y", "tip.apex_tolerance", "tip.layer", "tip.maxima"})
      values.forget(of_blind);
  }
  if (parameters.answer != workflow::TipAnswer::sweep)
    for (const char* of_sweep : {"tip.sweep", "tip.seed"}) values.forget(of_sweep);
  values.apply(parameters);
  workflow::check(parameters);
  return parameters;
}

int vtkSemsurfEstimateTip::RequestInformation(vtkInformation*, vtkInformationVector** inputs,
                                              vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    const int size = this->Parameters().size;
    double pitch[3] = {1, 1, 1};
    inputs[0]->GetInformationObject(0)->Get(vtkDataObject::SPACING(), pitch);
    const int samples = std::max(size, 2), apex = size / 2;
    pv::announce(outputs->GetInformationObject(0),
                 {{pitch[0], pitch[1], -apex * pitch[0], -apex * pitch[1]}, samples, samples});
    pv::announce_pieces(outputs->GetInformationObject(1));
  });
}

int vtkSemsurfEstimateTip::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                       vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    const workflow::TipParameters parameters = this->Parameters();
    std::string name;
    const std::vector<HeightField> scans{this->Heights(inputs, name)};
    if (const auto& z = scans[0].z_nm; parameters.size > std::min(z.width(), z.height()))
      throw UsageError("Tip Size",
                       fmt::format("{} samples are more than the scan's {} x {}", parameters.size,
                                   z.width(), z.height()),
                       "Give fewer");
    std::vector<std::string> warnings;
    workflow::TipResult found;
    pv::work(this, [&](const Watch& watch) {
      found = workflow::find_tip(scans, parameters, pv::hear(watch, warnings));
    });
    pv::warn(this, warnings);
    vtkNew<vtkTable> table;
    if (found.sweep) add_curve(table, *found.sweep);
    if (found.best) add_candidates(table, *found.best);
    if (found.blind)
      pv::add_quantities(table, {{"threshold_nm", *found.used.threshold_nm},
                                 {"apex_tolerance_nm", found.used.apex_tolerance_nm},
                                 {"rounds", static_cast<double>(found.blind->rounds)},
                                 {"points", static_cast<double>(found.blind->points)}});
    const auto image = pv::to_vtk(found.tip);
    pv::add_record(image, "tip", record_of(found.used));
    pv::give(outputs->GetInformationObject(0), image);
    pv::give(outputs->GetInformationObject(1), table);
  });
}
