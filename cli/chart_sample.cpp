// SPDX-License-Identifier: GPL-3.0-or-later
#include "chart_sample.h"

#include <fmt/format.h>

#include "exit_codes.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/workflow/chain_chart_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

std::string offset_text(const workflow::RegistrationPoint& p) {
  if (p.any_start) return "no start";
  return p.offset_deg > 0 ? fmt::format("{:g} degrees off", p.offset_deg)
                          : fmt::format("{:g} pixels off", p.offset_px);
}

void print_registration(const workflow::RegistrationPoint& p) {
  std::string text = fmt::format("{:<20} {:<16} {:>3} of {} right, {} wrong", p.family,
                                 offset_text(p), p.right, p.draws, p.wrong);
  if (p.verified > 0)
    text += fmt::format("; {:.2f} px off (median), {:.2f} at most", p.median_px, p.largest_px);
  print("{}; {} each\n", text, time_text(p.median_s));
}

void print_reconstruction(const workflow::ReconstructionPoint& p) {
  std::string text =
      fmt::format("{:<20} {:<38} {:>8}", p.family, p.setting, time_text(p.steps.back().run_s));
  if (p.preparation_s > 0) text += fmt::format(" + {}", time_text(p.preparation_s));
  print("{}  {:.3g} nm\n", text, p.steps.back().rms_nm);
}

std::string range_text(const std::optional<double>& range, bool open, const char* unit) {
  if (!range) return {};
  return fmt::format("{:g} {}{}", *range, unit, open ? " or more" : "");
}

void print_ranges(const workflow::ChainChartSummary& s) {
  for (const workflow::CaptureRange& r : s.ranges) {
    if (r.any_start) continue;
    std::string text = range_text(r.px, r.px_open, "pixels");
    const std::string turn = range_text(r.deg, r.deg_open, "degrees");
    if (!turn.empty()) text += (text.empty() ? "" : ", ") + turn;
    print("{:<20} captures from {}\n", r.family,
          text.empty() ? "none of the offsets that were tried" : text);
  }
}

}  // namespace

std::string time_text(double seconds) {
  return seconds >= 0.995 ? fmt::format("{:.3g} s", seconds)
                          : fmt::format("{:.3g} ms", 1e3 * seconds);
}

std::string chart_sample_methods() {
  std::string text;
  for (const workflow::ChainFamily& f : workflow::chain_chart_families())
    text += fmt::format("  {:<24}{}\n", f.name, f.what);
  return text;
}

int chart_sample(workflow::ChainChartJob job, bool quiet) {
  const std::filesystem::path cache = io::cache_folder("");
  job.models = cache.empty() ? job.folder / "models" : cache / "models";
  workflow::ChainChartSummary s;
  {
    JobReporter reporter(quiet);
    const auto tell = [&](const auto& print_it) {
      if (quiet) return;
      reporter.clear();
      print_it();
      flush();
    };
    workflow::ChainChartCallbacks points;
    points.registration = [&](const workflow::RegistrationPoint& p) {
      tell([&] { print_registration(p); });
    };
    points.reconstruction = [&](const workflow::ReconstructionPoint& p) {
      tell([&] { print_reconstruction(p); });
    };
    if (workflow::is_sample(job.sample))
      reporter->note(fmt::format(
          "{} is a sample whose truth is known: registration and reconstruction are charted",
          job.sample.string()));
    s = workflow::run(job, reporter, points);
  }
  if (!s.complete) {
    print_note(
        fmt::format("stopped: what is done is kept in {}; the same command goes on from there",
                    job.folder.string()));
    return exit_interrupted;
  }
  if (quiet) return 0;
  if (s.found > 0) print("{} points were there before\n", s.found);
  for (const std::string& text : s.left_out) print("left out: {}\n", text);
  print_ranges(s);
  if (!s.reconstructions.empty())
    print("the eroded scan is {:.3g} nm off; noise and prior alone leave {:.3g} nm\n", s.eroded_nm,
          s.floor_nm);
  for (const auto& path : s.written) print("written {}\n", path.string());
  return 0;
}

}  // namespace surf::cli
