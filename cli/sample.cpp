// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <optional>

#include "bound_parameters.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/workflow/sample_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* sample_examples =
    R"(A scan by a dull tip and an SEM image of a surface that is known at every place, with noise, tilt and an
unknown map between the two: something to reconstruct, and to judge a reconstruction by. Files whose
names have "truth" in them hold what it has to find out. The SEM image takes minutes. Stop when you like:
the same command goes on from there.

Examples:
  semsurf sample --list
  semsurf sample nist0523-thick -o thick
  semsurf sample terrain --electrons 50 --seed 2 -o noisy)";

struct SampleArguments {
  BoundParameters bound;
  bool list = false, quiet = false;
};

int list_samples() {
  for (const workflow::SampleScene& scene : workflow::sample_scenes())
    print("{:<16} {}\n", scene.name, scene.what);
  return 0;
}

workflow::SampleJob sample_job_of(const SampleArguments& o) {
  workflow::SampleJob job;
  job.cache = io::cache_folder("");
  o.bound.apply(job);
  if (job.name.empty())
    throw UsageError("NAME", "no sample is named", "Choose one that 'semsurf sample --list' shows");
  if (job.folder.empty()) throw UsageError("--output", "no folder is given", "Add -o FOLDER");
  return job;
}

/// Where there is no bar to show it: one line, as soon as the speed is known.
class TimeLeft {
 public:
  TimeLeft(bool wanted, const char* what) : wanted_(wanted), what_(what) {}

  void tell(double done, double total) {
    const auto now = Clock::now();
    if (!began_) {
      began_ = now;
      done_at_start_ = done;  // a resumed job begins in the middle
      return;
    }
    const double seconds = std::chrono::duration<double>(now - *began_).count();
    if (!wanted_ || seconds < enough_seconds || done <= done_at_start_) return;
    wanted_ = false;
    print_note(fmt::format("{:.0f} % of {} is done, about {} left", 100 * done / total, what_,
                           format_duration(seconds * (total - done) / (done - done_at_start_))));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double enough_seconds = 3;
  bool wanted_;
  const char* what_;
  std::optional<Clock::time_point> began_;
  double done_at_start_ = 0;
};

std::string why_stopped(const workflow::SampleJob& job, const workflow::SampleSummary& s) {
  if (!s.checkpoint.empty())
    return fmt::format(
        "stopped; what is done is kept in {}; the same command goes on from "
        "there",
        s.checkpoint.string());
  if (job.cache.empty()) return "stopped; nothing was written";
  return "stopped before a part of the image was done; cascades that are made stay in the cache";
}

int sample(const SampleArguments& o) {
  if (o.list) return list_samples();
  const workflow::SampleJob job = sample_job_of(o);
  workflow::SampleSummary s;
  {
    JobReporter reporter(o.quiet);
    const bool told = !o.quiet && !isatty(fileno(messages()));
    TimeLeft left(told, "the SEM image"), library_left(told, "the library");
    workflow::Reporter also = reporter;
    also.on_progress = [&](double done, double total, std::string_view things) {
      reporter->progress(done, total, things);
      (things == "cascades" ? library_left : left).tell(done, total);
    };
    s = workflow::run(job, also);
  }
  if (!s.complete) {
    print_note(why_stopped(job, s));
    return exit_interrupted;
  }
  if (o.quiet) return 0;
  print_line("AFM", fmt::format("{} x {} samples", s.afm_width, s.afm_height));
  print_line("SEM", fmt::format("{} x {} pixels of {} primaries, in {:.3g} s", job.width,
                                job.height, job.electrons, s.seconds));
  print_written(s.written);
  return 0;
}

}  // namespace

void add_sample(CLI::App& app, Action& action) {
  const auto o = std::make_shared<SampleArguments>();
  CLI::App* sub =
      app.add_subcommand("sample",
                         "A scan and an SEM image of a known surface, to try a reconstruction "
                         "on");
  sub->add_flag("--list", o->list, "List the surfaces");
  const char* making = "Making";
  o->bound.looks["sample.name"] = {.name = "NAME", .positional = true};
  o->bound.looks["output"] = {.name = "-o,--output"};
  o->bound.add<workflow::SampleJob>(*sub, "Options", {}, {"sample.name", "output"});
  o->bound.add<workflow::SampleJob>(
      *sub, making, {},
      {"sample.electrons", "sample.size", "simulation.physics", "sample.tip_lean",
       "sample.tip_azimuth", "sample.gain_drift", "sample.spot", "sample.detector", "sample.film",
       "sample.film_thickness", "sample.scan_drift", "sample.line_jitter", "sample.seed",
       "job.cache", "job.threads"});
  add_quiet_flag(*sub, o->quiet)->group(making);
  sub->footer(sample_examples);
  sub->callback([o, &action] { action = [o] { return sample(*o); }; });
}

}  // namespace surf::cli
