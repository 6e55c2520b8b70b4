// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfEstimateTip.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/table.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "surf/afm/best_tip.h"
#include "surf/afm/noise_estimate.h"
#include "surf/afm/tip_doubt.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/error.h"

vtkStandardNewMacro(vtkSemsurfEstimateTip);

using namespace surf;

namespace {

struct Found {
  Tip tip;
  double threshold_nm = 0;
  std::vector<std::string> warnings;
};

/// As `semsurf tip` takes it from the scan.
AfmNoise noise_of(const HeightField& scan, std::vector<std::string>& warnings) {
  const NoiseEstimate e = estimate_noise(scan);
  AfmNoise noise{e.noise.alpha, 0};
  noise.innovation_nm2 = e.noise.variance_nm2() * (1 - noise.alpha * noise.alpha);
  if (!(noise.innovation_nm2 > 0))
    throw InvalidInput("Input", "it has no noise that could be estimated",
                       "Set Noise, or the Answer 'At threshold'");
  if (e.alpha_at_limit)
    warnings.push_back(
        "the noise can hardly be told from the structure and may be less: set Noise, which 'Noise Model' "
        "finds on a flat scan");
  if (const std::string doubt = doubt_of_noise(noise, scan); !doubt.empty()) warnings.push_back(doubt + ": set Noise");
  return noise;
}

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

std::vector<std::string> doubts(const TipSweep& sweep) {
  const SweptTip& c = sweep.curve[sweep.chosen];
  if (sweep.verdict == TipSweepVerdict::disagreement)
    return {fmt::format(
        "the volume jumps at a threshold of {:.4g} nm, but the residuals choose {:.4g} nm: look at the "
        "curve, output 2",
        sweep.curve[sweep.jump].threshold_nm, c.threshold_nm)};
  return {};
}

}   // namespace

int vtkSemsurfEstimateTip::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

void vtkSemsurfEstimateTip::Check() const {
  if (this->TipSize < 1 || this->TipSize > 1001 || this->TipSize % 2 == 0)
    throw UsageError("Tip Size",
                     fmt::format("{} is no odd number from 1 to 1001, so that there is no middle for the "
                                 "apex",
                                 this->TipSize),
                     "Give 21 where in doubt");
  if (this->Answer < Sweep || this->Answer > Blind)
    throw UsageError("Answer", fmt::format("there is no answer {}", this->Answer), "Choose 0 to 3");
  pv::need_length(this->Noise, "Noise");
  pv::need_length(this->Threshold, "Threshold");
  pv::need_length(this->ApexTolerance, "Apex Tolerance");
  for (const double nm : this->ThresholdRange) pv::need_length(nm, "Threshold Range");
  if (this->ThresholdRange[1] != 0 && this->ThresholdRange[0] >= this->ThresholdRange[1])
    throw UsageError("Threshold Range", fmt::format("{} to {} nm is no range", this->ThresholdRange[0], this->ThresholdRange[1]),
                     "Give the least and the most, or 0 for both");
  pv::need_within(this->Thresholds, 2, 10000, "Thresholds");
  if (!(std::abs(this->NoiseCorrelation) < 1))
    throw UsageError("Noise Correlation", fmt::format("{} is not between -1 and 1", this->NoiseCorrelation),
                     "Give 0");
}

int vtkSemsurfEstimateTip::RequestInformation(vtkInformation*, vtkInformationVector** inputs,
                                              vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    this->Check();
    double pitch[3] = {1, 1, 1};
    inputs[0]->GetInformationObject(0)->Get(vtkDataObject::SPACING(), pitch);
    const int samples = std::max(this->TipSize, 2), apex = this->TipSize / 2;
    pv::announce(outputs->GetInformationObject(0),
                 {samples, samples, pitch[0], pitch[1], -apex * pitch[0], -apex * pitch[1]});
    pv::announce_pieces(outputs->GetInformationObject(1));
  });
}

int vtkSemsurfEstimateTip::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                       vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    this->Check();
    std::string name;
    const std::vector<HeightField> scans{this->Heights(inputs, name)};
    if (const auto& z = scans[0].z_nm; this->TipSize > std::min(z.width(), z.height()))
      throw UsageError("Tip Size", fmt::format("{} samples are more than the scan's {} x {}", this->TipSize, z.width(), z.height()),
                       "Give fewer");
    vtkNew<vtkTable> table;
    Found found;
    AfmNoise noise{0, 0};
    pv::work(this, [&](const Watch& watch) {
      BlindTipOptions blind{.width = this->TipSize, .height = this->TipSize};
      if (this->Answer != Blind) {
        const double alpha = this->NoiseCorrelation, sigma = this->Noise;
        noise = sigma > 0 ? AfmNoise{alpha, sigma * sigma * (1 - alpha * alpha)}
                          : noise_of(scans[0], found.warnings);
      }
      if (this->Answer == Sweep) {
        const TipSweep sweep = sweep_tips(scans,
                                          {.blind = blind,
                                           .noise = noise,
                                           .least_nm = this->ThresholdRange[0],
                                           .most_nm = this->ThresholdRange[1],
                                           .thresholds = this->Thresholds,
                                           .seed = static_cast<std::uint64_t>(this->Seed)},
                                          watch.progress, watch.cancel);
        watch.check();
        found.tip = sweep.curve[sweep.chosen].tip;
        found.threshold_nm = sweep.curve[sweep.chosen].threshold_nm;
        found.tip.doubt = doubt_of_tip(sweep);
        for (const std::string& doubt : doubts(sweep)) found.warnings.push_back(doubt);
        add_curve(table, sweep);
      } else if (this->Answer == Best) {
        BestTipSummary summary;
        found.tip = best_tip(scans, {.width = this->TipSize, .height = this->TipSize, .noise = noise},
                             summary, watch.progress, watch.cancel);
        watch.check();
        found.threshold_nm = summary.chosen.threshold_nm;
        add_candidates(table, summary);
      } else {
        blind.threshold_nm = this->Threshold;
        blind.apex_tolerance_nm = this->ApexTolerance;
        if (this->Answer == OuterBound)
          blind.threshold_nm = blind.apex_tolerance_nm = outer_threshold_nm(
              noise, static_cast<double>(scans[0].z_nm.size()), this->TipSize * this->TipSize);
        BlindTipSummary summary;
        found.tip = blind_tip(scans, blind, summary, watch.progress, watch.cancel);
        watch.check();
        found.threshold_nm = blind.threshold_nm;
        pv::add_quantities(table, {{"threshold_nm", blind.threshold_nm},
                                   {"apex_tolerance_nm", blind.apex_tolerance_nm},
                                   {"rounds", static_cast<double>(summary.rounds)},
                                   {"points", static_cast<double>(summary.points)}});
      }
    });
    if (this->Answer != Sweep) found.tip.doubt = doubt_of_shape(found.tip);
    if (!found.tip.doubt.empty())
      found.warnings.push_back(fmt::format("this tip is not to be trusted: {}. Is the scan level, is Noise right, is Tip Size "
                                           "large enough?", found.tip.doubt));
    for (const std::string& warning : found.warnings) pv::warn(this, warning);
    const auto image = pv::to_vtk(found.tip);
    std::map<std::string, std::string> made{{"threshold_nm", fmt::format("{:.9g}", found.threshold_nm)}};
    if (this->Answer != Blind) {
      made["noise_nm"] = fmt::format("{:.9g}", std::sqrt(noise.variance_nm2()));
      made["noise_alpha"] = fmt::format("{:.9g}", noise.alpha);
    }
    pv::add_texts(image, made);
    pv::give(outputs->GetInformationObject(0), image);
    pv::give(outputs->GetInformationObject(1), table);
  });
}
