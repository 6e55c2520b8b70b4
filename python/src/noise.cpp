// SPDX-License-Identifier: GPL-3.0-or-later
// The noise of scans and of SEM images.
#include <cmath>

#include "arrays.h"
#include "scan_findings.h"
#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/scene_file.h"
#include "surf/sem/estimate_sem_noise.h"
#include "surf/workflow/count_job.h"
#include "surf/workflow/fitted_counts.h"
#include "surf/workflow/noise_job.h"
#include "surf/workflow/step_record.h"

namespace surf::python {
namespace {

py::object found_of(const NoiseCheck& c) {
  const auto correlations = [](const std::vector<LagCorrelation>& lags) {
    std::vector<double> values;
    for (const LagCorrelation& lag : lags) values.push_back(lag.correlation);
    return array_of(std::move(values));
  };
  py::dict d;
  d["along_p"] = c.along_p;
  d["across_p"] = c.across_p;
  d["normal_p"] = c.normal_p;
  d["skewness"] = c.skewness;
  d["excess_kurtosis"] = c.excess_kurtosis;
  d["along"] = correlations(c.along);
  d["across"] = correlations(c.across);
  return findings(d);
}

py::object noise(const Call& call) {
  const auto parameters = call.told<workflow::ScanNoiseParameters>();
  const Heights scan = heights_of(call, "scan");
  std::vector<std::filesystem::path> inputs = files_of({&scan});
  const Mask use = masks_of(call, scan.field, inputs);
  workflow::ScanNoise found;
  call.work([&](const workflow::Reporter& reporter) {
    found = workflow::noise_of_scan(scan.field, parameters, use, reporter);
  });
  const NoiseEstimate& e = found.estimate;
  py::dict d;
  d["alpha"] = e.noise.alpha;
  d["alpha_stderr"] = e.alpha_stderr;
  d["sigma_nm"] = e.sigma_nm();
  d["sigma_stderr_nm"] = e.sigma_stderr_nm;
  d["innovation_nm2"] = e.noise.innovation_nm2;
  d["innovation_stderr_nm2"] = e.innovation_stderr_nm2;
  d["samples"] = e.samples;
  d["substrate_share"] = found.substrate_share;
  if (found.check) d["check"] = found_of(*found.check);
  d["mask"] = array_of(found.samples);
  d["residual_nm"] = array_of(std::move(found.residual_nm));
  d["white"] = array_of(std::move(found.white));
  d["record"] = record_of(
      workflow::step_record("noise scan", workflow::records_of(parameters, scan.reading), inputs));
  return findings(d);
}

py::object noise_sem(const Call& call) {
  const auto options = call.told<SemNoiseOptions>();
  workflow::SemInput sem = sem_of(call, call["image"], "image");
  SemNoiseEstimate e;
  {
    const py::gil_scoped_release unlocked;
    e = estimate_sem_noise(sem.image, options);
  }
  for (const std::string& warning : e.warnings) Call::warn(warning);
  py::dict d;
  d["slope"] = e.noise.slope;
  d["slope_stderr"] = e.slope_stderr();
  d["slope_known"] = e.slope_known;
  d["intercept"] = e.noise.intercept;
  d["intercept_stderr"] = e.intercept_stderr();
  d["p"] = e.p;
  d["least_mean"] = e.least_mean;
  d["largest_mean"] = e.largest_mean;
  d["correlation_x"] = e.correlation_x;
  d["correlation_y"] = e.correlation_y;
  d["excess_kurtosis"] = e.excess_kurtosis;
  d["pixels"] = e.pixels;
  std::vector<double> means, variances, errors;
  for (const NoisePoint& point : e.points) {
    if (!point.used) continue;
    means.push_back(point.mean), variances.push_back(point.variance);
    errors.push_back(point.variance_stderr);
  }
  d["means"] = array_of(std::move(means));
  d["variances"] = array_of(std::move(variances));
  d["variances_stderr"] = array_of(std::move(errors));
  return findings(d);
}

py::object found_of(const CountFit& fit) {
  py::dict d;
  d["chi_squared"] = fit.chi_squared;
  d["degrees"] = fit.degrees;
  d["p"] = fit.degrees > 0 ? py::object(py::float_(fit.p)) : py::object(py::none());
  return findings(d);
}

py::object found_of(const workflow::FittedCounts& f) {
  py::dict d;
  d["detector"] = f.set.detector;
  d["electrons"] = f.set.electrons;
  d["counts"] = array_of(f.set.counts);
  d["mean"] = f.moments.mean;
  d["variance"] = f.moments.variance;
  d["skewness"] = f.moments.skewness;
  d["poisson"] = found_of(test_fit(f.set.counts, f.poisson));
  if (f.spread) {
    d["log_normal"] = found_of(test_fit(f.set.counts, f.log_normal));
    d["normal"] = found_of(test_fit(f.set.counts, f.normal));
  }
  return findings(d);
}

py::object noise_counts(const Call& call) {
  workflow::CountJob job;
  call.apply(job);  // numbers are looked at before the scene is read
  workflow::CountSummary s;
  const std::string scene = path_of(call["scene"]);
  call.work([&](const workflow::Reporter& reporter) {
    job.scene = io::read_scene(scene);
    job.seed = job.scene.seed;
    call.apply(job);
    s = workflow::run(job, reporter);
  });
  py::list sets;
  for (const workflow::DetectorCounts& set : s.sets)
    sets.append(found_of(workflow::fit_counts(set)));
  py::dict d;
  d["hit_nm"] = py::make_tuple(s.hit_nm.x, s.hit_nm.y, s.hit_nm.z);
  d["sets"] = sets;
  return findings(d);
}

}  // namespace

void add_noise(py::module_& module) {
  Function f{.name = "noise",
             .summary = "The noise of an AFM scan, and whether the model fits.",
             .arguments = {scan_argument, use_argument, exclude_argument}};
  f.details =
      "The model is e(t) = alpha e(t - 1) + v(t) along scan lines. It is estimated from the\n"
      "substrate, the plane that most of the scan lies on, or with `flat` from all of it.";
  f.result_type = "Findings";
  f.result =
      "`alpha`, `sigma_nm` and `innovation_nm2` with their standard errors, `check` with the "
      "probabilities of the tests, and the residuals.";
  define(module, f.takes<workflow::ScanNoiseParameters>().takes<io::HeightReadOptions>(), noise);

  Function sem{.name = "noise_sem",
               .summary = "The noise of an SEM image: the line variance = slope mean + intercept.",
               .arguments = {{"image", sem_type, "The image.", true, false}}};
  sem.result_type = "Findings";
  sem.result = "`slope` and `intercept` with their standard errors, and the points of the line.";
  sem.is_long = false;
  define(module, sem.takes<SemNoiseOptions>().takes<io::SemReadOptions>(), noise_sem);

  Function counts{.name = "noise_counts",
                  .summary = "Count the electrons from a stationary beam, many times over."};
  counts.arguments = {{"scene", "PathLike", "A scene (TOML).", true, false}};
  counts.result_type = "Findings";
  counts.result =
      "`sets` by number of electrons and detector: how many trials gave each of the `counts` 0, 1, "
      "2 ..., their moments, and how well distributions fit.";
  define(module, counts.takes<workflow::CountJob>(), noise_counts);
}

}  // namespace surf::python
