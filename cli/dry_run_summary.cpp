// SPDX-License-Identifier: GPL-3.0-or-later
#include "dry_run_summary.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "joined_team.h"
#include "surf/core/units.h"
#include "terminal.h"

namespace surf::cli {
namespace {

void print_time(const workflow::DryRun& run) {
  const mc::Pilot& p = run.pilot;
  const std::string with = run.ranks > 1
                               ? fmt::format("{} ranks of {} threads", run.ranks, run.threads)
                               : fmt::format("{} threads", run.threads);
  const std::string from =
      !p.whole
          ? fmt::format("from {} pieces of {} units in {:.1f} s", format_count(double(p.units)),
                        format_count(double(p.units_in_all)), p.seconds)
      : p.units == p.units_in_all
          ? std::string("all of it was tried")
          : fmt::format("from {} of {} units in {:.1f} s", format_count(double(p.units)),
                        format_count(double(p.units_in_all)), p.seconds);
  // Seconds of a day would be noise.
  const auto rounded = [&](double s) {
    if (run.expected_s < 90) return fmt::format("{:.2g} s", s);
    if (run.expected_s < 5400) return fmt::format("{:.2g} min", s / 60);
    if (run.expected_s < 2 * 86400) return fmt::format("{:.2g} h", s / 3600);
    return fmt::format("{:.2g} days", s / 86400);
  };
  if (run.standard_error_s > 0)
    print_line("time", fmt::format("{} ± {} on {}; {}", rounded(run.expected_s),
                                   rounded(run.standard_error_s), with, from));
  else print_line("time", fmt::format("{} on {}; {}", rounded(run.expected_s), with, from));
  if (p.planes_s > 0)
    print_line("planes", fmt::format("{} to compare pixels with: {} of that time", p.planes,
                                     rounded(p.planes_s)));
  if (p.library_cascades > 0)
    print_line(
        "library",
        fmt::format("{} cascades of each material, got in {:.1f} s and kept for the run itself",
                    format_count(double(p.library_cascades)), p.library_seconds));
}

void print_memory(const workflow::DryRun& run) {
  std::string parts;
  for (const workflow::MemoryNeed& need : run.memory)
    if (need.bytes >= 0.005 * run.memory_bytes)
      parts +=
          fmt::format("{}{} {}", parts.empty() ? "" : ", ", format_bytes(need.bytes), need.what);
  print_line("memory", fmt::format("{}{}: {}", format_bytes(run.memory_bytes),
                                   run.ranks > 1 ? " each rank" : "", parts));
  if (const double all = run.memory_bytes * processes_here(); all > run.memory_there)
    print_warning(fmt::format("{} of memory are there, and {} would be taken",
                              format_bytes(run.memory_there), format_bytes(all)));
}

void print_disk(const workflow::DryRun& run) {
  std::string label = "disk";
  for (const workflow::DiskNeed& need : run.disk) {
    std::error_code error;
    const auto space = std::filesystem::space(need.folder, error);
    print_line(label,
               fmt::format("up to {} for {}{}{}", format_bytes(need.bytes),
                           need.in_the_end ? need.what : "the " + need.what,
                           need.in_the_end ? "" : ", on the way",
                           error || label.empty()
                               ? std::string()
                               : fmt::format(" ({} free)", format_bytes(double(space.available)))));
    label.clear();
  }
}

}  // namespace

void print_dry_run(const workflow::DryRun& run) {
  const mc::Scan& scan = run.scan;
  const mc::Pilot& p = run.pilot;
  print_line("image", fmt::format("{} x {} pixels, {} x {}", scan.width, scan.height,
                                  format_length(scan.width * scan.pixel_x_nm),
                                  format_length(scan.height * scan.pixel_y_nm)));
  print_line("triangles", format_count(double(run.scene.triangles)));
  print_line("method", fmt::format("{}: {}", mc::name(run.choice.method), run.choice.reason));
  print_line("primaries", fmt::format("{}, {:.3g} per pixel", format_count(p.primaries),
                                      p.primaries / (double(scan.width) * scan.height)));
  print_line("rays", format_count(p.rays));
  print_time(run);
  print_memory(run);
  print_disk(run);
}

}  // namespace surf::cli
