// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "../compare_truth.h"
#include "../sem_frame.h"
#include "chain_methods.h"
#include "peak_memory.h"
#include "surf/afm/morphology.h"
#include "surf/core/error.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Compares a surface in the scan's frame with the truth in the SEM image's frame.
double rms_under_sem(const HeightField& surface, const SampleTruth& sample) {
  SurfaceUnderSem under = surface_under_sem(surface, sample.sem.image, sample.sem.sem_to_afm);
  under.surface.valid = under.known;
  return rms_off(under.surface, sample.truth);
}

/// Records the end time and the error of each scale. The time spent on measuring is not counted.
class Steps : public ReconstructionJournal {
 public:
  Steps(const HeightField& truth, std::vector<ReconstructionStep>& steps)
      : truth_(truth), steps_(steps) {}
  std::optional<ReconstructionState> found() override { return {}; }
  void keep(const ReconstructionState& state) override {
    const auto asked = Clock::now();
    steps_.push_back({state.scales.back().sigma_px,
                      std::chrono::duration<double>(asked - begin_).count(),
                      rms_off(state.surface, truth_)});
    begin_ += Clock::now() - asked;
  }
  double seconds() const { return seconds_since(begin_); }

 private:
  const HeightField& truth_;
  std::vector<ReconstructionStep>& steps_;
  Clock::time_point begin_ = Clock::now();
};

void count(const Reconstruction& r, ReconstructionPoint& point) {
  for (const ScaleReport& s : r.scales) {
    point.iterations += s.iterations;
    point.evaluations += s.evaluations;
    point.products += s.products;
  }
  if (!r.scales.empty()) point.ended = r.scales.back().ended;
}

enum class Data { afm, sem, both };

void measure(Data data, ReconstructionOptions options, const ChainSetting& setting,
             const Watch& watch, ReconstructionPoint& point) {
  const SampleTruth& sample = setting.sample;
  options.uncertainty = false;
  options.threads = setting.job.threads;
  options.watch = watch;
  Steps steps(sample.truth, point.steps);
  // The scan alone is reconstructed on its own samples. Only its final surface is interpolated at
  // the truth's samples.
  const Reconstruction r = reconstruct(data == Data::sem ? nullptr : &sample.afm,
                                       data == Data::afm ? nullptr : &sample.sem, options,
                                       data == Data::afm ? nullptr : &steps);
  const double run_s = steps.seconds();
  count(r, point);
  const double sigma_px = r.scales.empty() ? 0 : r.scales.back().sigma_px;
  const ReconstructionStep end{
      sigma_px, run_s,
      data == Data::afm ? rms_under_sem(r.surface, sample) : rms_off(r.surface, sample.truth)};
  if (point.steps.empty()) point.steps.push_back(end);
  else point.steps.back() = end;  // the end of the last scale, including the steps after it
}

void erode_alone(const ChainSetting& setting, const Watch& watch, ReconstructionPoint& point) {
  MorphologyOptions options;
  options.threads = setting.job.threads;
  options.watch = watch;
  const auto begin = Clock::now();
  const HeightField surface = erode(setting.sample.afm.image, setting.sample.afm.tip, options);
  const double run_s = seconds_since(begin);
  point.steps = {{0, run_s, rms_under_sem(surface, setting.sample)}};
}

void whole_chain(const ChainSetting& setting, const Watch& watch, ReconstructionPoint& point) {
  const SampleTruth& sample = setting.sample;
  ReconstructJob job;
  job.afm = AfmInput{sample.scan, setting.job.sample / "afm.gsf", {}};
  job.sem = SemInput{sample.sem.image, setting.job.sample / "sem.tif"};
  job.model.file = setting.model.file;
  job.truth = sample.truth;
  job.options.threads = setting.job.threads;
  job.options.uncertainty = false;
  const auto begin = Clock::now();
  double prepared_s = 0;
  Reporter reporter;
  reporter.cancel = watch.cancel;
  double stages = 0;
  reporter.on_stage = [&](const std::string& stage) {
    if (stage == "reconstruction") prepared_s = seconds_since(begin);
    stages += 1;
  };
  constexpr double all_stages = 5;  // model, scan, registration, calibration, reconstruction
  reporter.on_progress = [&](double done, double total, std::string_view) {
    if (total > 0)
      watch.report(std::min(all_stages, std::max(stages, 1.0) - 1 + done / total), all_stages);
  };
  const ReconstructSummary s = run(job, reporter);
  if (s.verdict == ReconstructionVerdict::not_registered)
    throw InvalidInput("chain", s.reasons.front(), "Nothing was reconstructed");
  point.preparation_s = prepared_s;
  count(s.result, point);
  point.steps = {{s.result.scales.empty() ? 0 : s.result.scales.back().sigma_px,
                  seconds_since(begin) - prepared_s, s.truth->rms_nm}};
}

}  // namespace

std::vector<ChainMethod<ReconstructionPoint>> list_reconstructions(const ChainChartJob& job) {
  using Run = std::function<void(const ChainSetting&, const Watch&, ReconstructionPoint&)>;
  std::vector<ChainMethod<ReconstructionPoint>> out;
  const auto add = [&](const std::string& family, const std::string& id, const std::string& text,
                       Run run) {
    if (!wants(job, family)) return;
    ReconstructionPoint point;
    point.id = id;
    point.family = family;
    point.setting = text;
    out.push_back({std::move(point), std::move(run)});
  };
  const auto both = [&](ReconstructionMethod method, const std::string& id, const std::string& text,
                        int iterations, double tolerance) {
    ReconstructionOptions o;
    o.method = method;
    o.iterations = iterations;
    o.tolerance = tolerance;
    add(name(method), id, text,
        [o](const ChainSetting& s, const Watch& watch, ReconstructionPoint& p) {
          measure(Data::both, o, s, watch, p);
        });
  };
  add("erosion", "erosion", "the scan with the tip taken off", erode_alone);
  ReconstructionOptions one;
  if (job.quick) one.iterations = 5;
  const std::string limit = job.quick ? ", 5 iterations a scale" : "";
  add("afm", "afm", "Gauss-Newton" + limit,
      [one](const ChainSetting& s, const Watch& watch, ReconstructionPoint& p) {
        measure(Data::afm, one, s, watch, p);
      });
  add("sem", "sem", "Gauss-Newton" + limit,
      [one](const ChainSetting& s, const Watch& watch, ReconstructionPoint& p) {
        measure(Data::sem, one, s, watch, p);
      });
  using enum ReconstructionMethod;
  if (job.quick) {
    both(gauss_newton, "gauss-newton-5", "5 iterations a scale", 5, 0);
    both(conjugate_gradients, "conjugate-gradients-5", "5 iterations a scale", 5, 0);
    both(lbfgs, "lbfgs-5", "5 iterations a scale", 5, 0);
    return out;
  }
  both(gauss_newton, "gauss-newton-3", "3 iterations a scale", 3, 0);
  both(gauss_newton, "gauss-newton-0.01", "tolerance 0.01", 0, 0.01);
  both(gauss_newton, "gauss-newton", "tolerance 0.0005", 0, 0);
  for (const auto method : {conjugate_gradients, lbfgs})
    for (const int iterations : {10, 50, 200})
      both(method, fmt::format("{}-{}", name(method), iterations),
           fmt::format("{} iterations a scale", iterations), iterations, 0);
  add("chain", "chain", "tip, noise, map and gains found, too", whole_chain);
  if (!out.empty() && out.back().point.family == "chain") out.back().point.is_default = true;
  return out;
}

}  // namespace surf::workflow
