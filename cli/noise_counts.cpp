// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_counts.h"

#include <fmt/format.h>

#include <memory>
#include <sstream>

#include "common_options.h"
#include "counts_plot.h"
#include "job_reporter.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/workflow/count_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

std::vector<std::int64_t> parse_electrons(const std::string& text) {
  std::vector<std::int64_t> numbers;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) numbers.push_back(parse_whole(word, "--electrons", 1, 1'000'000));
  if (numbers.empty()) throw UsageError("--electrons", "no number is given", "Write for example 1,20,100");
  return numbers;
}

std::pair<double, double> parse_point(const std::string& text) {
  const auto comma = text.find(',');
  if (comma == std::string::npos) throw UsageError("--at", "it is not a point", "Write two lengths, X,Y");
  return {parse_length_nm(text.substr(0, comma), "--at"), parse_length_nm(text.substr(comma + 1), "--at")};
}

workflow::CountJob make_job(const CountsInput& input) {
  workflow::CountJob job;
  if (input.electrons) job.electrons = parse_electrons(*input.electrons);
  if (input.trials) job.trials = parse_whole(*input.trials, "--trials", 100, 10'000'000);
  if (input.at) job.at_nm = parse_point(*input.at);
  job.threads = parse_threads(input.threads);
  job.scene = io::read_scene(*input.scene);
  job.seed = input.seed ? parse_seed(*input.seed, "--seed") : job.scene.seed;
  return job;
}

std::string format_fit(const CountFit& fit) {
  if (fit.degrees == 0) return "too few counts to test";
  return fmt::format("chi-squared {:.4g} with {} degrees, {}", fit.chi_squared, fit.degrees,
                     fit.p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.4f}", fit.p));
}

void print_set(const FittedCounts& f) {
  const CountMoments& m = f.moments;
  print("{:<12} {} a trial: mean {:.4g}, variance {:.4g}, skewness {:.3g}\n",
             fmt::format("{} of {}", f.set.detector, f.set.electrons), f.set.detector, m.mean, m.variance, m.skewness);
  print("{:<12} Poisson, mean {:.4g}: {}\n", "", f.poisson.mean, format_fit(test_fit(f.set.counts, f.poisson)));
  if (!f.spread) return;
  print("{:<12} log-normal, median {:.4g}, scale {:.4g}, shape {:.3g}: {}\n", "", f.log_normal.median,
             f.log_normal.scale, f.log_normal.shape, format_fit(test_fit(f.set.counts, f.log_normal)));
  print("{:<12} normal: {}\n", "", format_fit(test_fit(f.set.counts, f.normal)));
}

}  // namespace

void add_counts_options(CLI::App& app, CountsInput& input, const std::string& group) {
  app.add_option("--at", input.at, "Point of the image that the beam stands on, X,Y (its middle)")
      ->type_name("POINT")
      ->group(group);
  app.add_option("--electrons", input.electrons, "Primaries in a trial (1,20,100)")->type_name("N,N,...")->group(group);
  app.add_option("--trials", input.trials, "Trials with each number of primaries (10000)")
      ->type_name("N")
      ->group(group);
  app.add_option("--seed", input.seed, "Seed of the random numbers (the scene's, or 1)")->type_name("N")->group(group);
  add_threads_option(app, input.threads)->group(group);
  app.add_option("--csv", input.csv, "Table of the counts, seen and expected")->type_name("FILE.csv")->group(group);
}

void require_counts(const CountsInput& input) {
  if (input.scene) return;
  const char* given = input.at ? "--at" : input.electrons ? "--electrons" : input.trials ? "--trials" : input.seed ? "--seed"
                      : input.threads ? "--threads" : input.csv ? "--csv" : nullptr;
  if (given)
    throw UsageError(given, "it is of simulated counts, and no scene is given", "Add --counts scene.toml, or leave it out");
}

int print_counts(const CountsInput& input, const std::optional<std::string>& plot, bool quiet) {
  if (plot) io::check_plot_target(*plot);
  if (input.csv) io::check_writable(*input.csv);
  const workflow::CountJob job = make_job(input);
  workflow::CountSummary summary;
  {
    const JobReporter reporter(quiet);
    summary = workflow::run(job, reporter);
  }
  if (!quiet)
    print("{:<12} {} trials where the beam meets ({:.4g}, {:.4g}, {:.4g}) nm\n", "counts", job.trials, summary.hit_nm.x,
               summary.hit_nm.y, summary.hit_nm.z);
  std::vector<FittedCounts> sets;
  for (const workflow::DetectorCounts& set : summary.sets) {
    sets.push_back(fit(set));
    print_set(sets.back());
  }
  if (input.csv) io::write_text(*input.csv, counts_csv(sets));
  if (plot) io::write_plot(*plot, plot_counts(sets, static_cast<int>(sets.size() / job.electrons.size())));
  if (quiet) return 0;
  for (const auto& file : {input.csv, plot})
    if (file) print("{:<12} {}\n", "written", *file);
  return 0;
}

}  // namespace surf::cli
