// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_counts.h"

#include <fmt/format.h>

#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/workflow/count_job.h"
#include "surf/workflow/fitted_counts.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

workflow::CountJob noise_counts_job_of(const BoundParameters& bound, const std::string& scene) {
  workflow::CountJob job;
  bound.apply(job);  // numbers are looked at before the scene is read
  job.scene = io::read_scene(scene);
  job.seed = job.scene.seed;
  bound.apply(job);
  return job;
}

std::string format_fit(const CountFit& fit) {
  if (fit.degrees == 0) return "too few counts to test";
  return fmt::format("chi-squared {:.4g} with {} degrees, {}", fit.chi_squared, fit.degrees,
                     fit.p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.4f}", fit.p));
}

void print_set(const workflow::FittedCounts& f) {
  const CountMoments& m = f.moments;
  print("{:<12} {} a trial: mean {:.4g}, variance {:.4g}, skewness {:.3g}\n",
        fmt::format("{} of {}", f.set.detector, f.set.electrons), f.set.detector, m.mean,
        m.variance, m.skewness);
  print("{:<12} Poisson, mean {:.4g}: {}\n", "", f.poisson.mean,
        format_fit(test_fit(f.set.counts, f.poisson)));
  if (!f.spread) return;
  print("{:<12} log-normal, median {:.4g}, scale {:.4g}, shape {:.3g}: {}\n", "",
        f.log_normal.median, f.log_normal.scale, f.log_normal.shape,
        format_fit(test_fit(f.set.counts, f.log_normal)));
  print("{:<12} normal: {}\n", "", format_fit(test_fit(f.set.counts, f.normal)));
}

}  // namespace

void describe(ParameterVisitor& visit, CountsFiles& files) {
  visit(files.scene,
        {.name = "counts.scene", .help = "A scene (TOML)", .form = "FILE", .file = FileRole::read});
  visit(files.csv, {.name = "counts.csv",
                    .help = "Table of the counts, seen and expected",
                    .form = "FILE.csv",
                    .file = FileRole::written});
}

void add_counts_options(CLI::App& app, BoundParameters& bound, const std::string& group) {
  bound.add<workflow::CountJob>(app, group);
  bound.add<CountsFiles>(app, group, {}, {"counts.csv"});
}

int print_counts(const BoundParameters& bound, const std::optional<std::string>& plot, bool quiet) {
  CountsFiles files;
  bound.apply(files);
  if (files.scene.empty()) throw UsageError("noise", "no scene is given", "Name a file to read");
  if (plot) io::check_plot_target(*plot);
  if (!files.csv.empty()) io::check_writable(files.csv);
  const workflow::CountJob job = noise_counts_job_of(bound, files.scene);
  workflow::CountSummary summary;
  {
    const JobReporter reporter(quiet);
    summary = workflow::run(job, reporter);
  }
  if (!quiet)
    print("{:<12} {} trials where the beam meets ({:.4g}, {:.4g}, {:.4g}) nm\n", "counts",
          job.trials, summary.hit_nm.x, summary.hit_nm.y, summary.hit_nm.z);
  std::vector<workflow::FittedCounts> sets;
  for (const workflow::DetectorCounts& set : summary.sets) {
    sets.push_back(workflow::fit_counts(set));
    print_set(sets.back());
  }
  const auto made = workflow::step_record(
      "noise counts",
      workflow::records_of(job, static_cast<const mc::SimulationRequest&>(job.scene)),
      {files.scene});
  if (!files.csv.empty()) io::write_text(files.csv, workflow::counts_csv(sets, made));
  if (plot) {
    io::Plot drawn =
        workflow::plot_counts(sets, static_cast<int>(sets.size() / job.electrons.size()));
    drawn.metadata = made;
    io::write_plot(*plot, drawn);
  }
  if (quiet) return 0;
  for (const std::string& file : {files.csv, plot.value_or("")})
    if (!file.empty()) print("{:<12} {}\n", "written", file);
  return 0;
}

}  // namespace surf::cli
