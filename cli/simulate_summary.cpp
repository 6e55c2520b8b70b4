// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "surf/core/parallel.h"
#include "surf/core/units.h"
#include "terminal.h"

namespace surf::cli {
namespace {

std::string whole_percent(double part, double whole) {
  const double p = whole > 0 ? 100 * part / whole : 0;
  return p > 0 && p < 1 ? "< 1 %" : fmt::format("{:.0f} %", p);
}

void print_image(const workflow::SimulateSummary& s) {
  const mc::Scan& scan = s.scan;
  const std::string pixel =
      scan.pixel_x_nm == scan.pixel_y_nm
          ? format_length(scan.pixel_x_nm)
          : format_length(scan.pixel_x_nm) + " x " + format_length(scan.pixel_y_nm);
  print_line("image", fmt::format("{} x {} pixels of {}, {} x {}{}", scan.width, scan.height, pixel,
                                  format_length(scan.width * scan.pixel_x_nm),
                                  format_length(scan.height * scan.pixel_y_nm),
                                  s.result.complete ? "" : " (partial)"));
}

void print_yields(const workflow::SimulateSummary& s) {
  std::size_t width = 10;
  for (const mc::Detector& d : s.result.detectors) width = std::max(width, d.name.size());
  for (std::size_t d = 0; d < s.result.detectors.size(); ++d) {
    const mc::Estimate& y = s.statistics.yields[d];
    print("{:<{}} {:.4f} ± {:.4f}{}\n", s.result.detectors[d].name, width, y.mean, y.standard_error,
          d == 0 ? fmt::format(" per primary, mean over {} pixels", s.statistics.seen) : "");
  }
}

void print_library(const workflow::SimulateSummary& s) {
  if (s.result.library_cascades == 0) return;
  const std::string from = s.pages_made == 0 ? "from the cache"
                           : s.pages_loaded == 0
                               ? "made"
                               : fmt::format("{} from the cache, the rest made",
                                             whole_percent(double(s.pages_loaded),
                                                           double(s.pages_loaded + s.pages_made)));
  print_line("library", fmt::format("{} cascades of each material, {} in {:.1f} s",
                                    s.result.library_cascades, from, s.result.library_seconds));
}

// Which share of the pixels that see the specimen was done how, and which of the electrons went
// there.
void print_models(const workflow::SimulateSummary& s) {
  const mc::ResultSummary& r = s.statistics;
  if (mc::accuracy_of(s.result.budget) <= 0 || r.seen == 0) return;
  const double all = r.mean_electrons * double(r.seen);
  std::string text;
  for (const auto& [model, words] :
       {std::pair{mc::PixelModel::plane, "proved planes, which take no electrons"},
        std::pair{mc::PixelModel::difference, "as differences to planes"},
        std::pair{mc::PixelModel::replay, "by replay alone"},
        std::pair{mc::PixelModel::direct, "directly"}}) {
    const auto n = r.models[static_cast<std::size_t>(model)];
    if (n == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ",
                        whole_percent(double(n), double(r.seen)), words);
    const auto electrons = r.electrons[static_cast<std::size_t>(model)];
    if (electrons > 0)
      text += fmt::format(" ({} of the electrons)", whole_percent(double(electrons), all));
  }
  print_line("pixels", text);
}

void print_electrons(const workflow::SimulateSummary& s) {
  const mc::ResultSummary& r = s.statistics;
  if (const double dose = mc::dose_of(s.result.budget); dose > 0)
    print_line("dose", fmt::format("{:.4g} primaries per pixel on average", dose));
  const double accuracy = mc::accuracy_of(s.result.budget);
  if (accuracy <= 0) return;
  print_line("electrons", fmt::format("{:.0f} per pixel on average, {} to {}", r.mean_electrons,
                                      r.fewest_electrons, r.most_electrons));
  print_line(
      "accuracy",
      r.missed == 0
          ? fmt::format("{} reached {}", format_share(accuracy),
                        s.gains.empty() ? "in every pixel"
                                        : fmt::format("around every pixel, in {} rounds", s.rounds))
          : fmt::format("{} not reached in {} of {} pixels", format_share(accuracy), r.missed,
                        r.seen));
  if (s.tier) print_line("physics", *s.tier);
}

void print_guided(const workflow::SimulateSummary& s) {
  if (s.gains.empty()) return;
  print_line("guided", s.guided_by);
  for (std::size_t d = 0; d < s.gains.size(); ++d) {
    const workflow::GuidedGain& gain = s.gains[d];
    print_line("", fmt::format("{} {}", s.result.detectors[d].name, format_gain(gain)));
  }
}

void print_speed(int threads, const workflow::SimulateSummary& s) {
  const double recalled = double(s.result.recalled);
  const double primaries = double(s.result.balance.incident) - recalled;
  const double seconds = s.result.seconds;
  print_line("primaries", fmt::format("{}{} in {:.1f} s, {} per second on {} threads",
                                      recalled > 0 ? format_count(recalled) + " done before, " : "",
                                      format_count(primaries), seconds,
                                      format_count(seconds > 0 ? primaries / seconds : 0),
                                      resolve_threads(threads)));
}

void print_simplified(const workflow::Simplification& s) {
  std::string label = "simplified";
  for (const workflow::SimplifiedBody& body : s.bodies) {
    print_line(label, workflow::describe(body));
    label.clear();
  }
  if (!s.bodies.empty())
    print_line("",
               fmt::format("{} allowed, took {:.1f} s", format_length(s.tolerance_nm), s.seconds));
}

}  // namespace

std::string format_gain(const workflow::GuidedGain& gain) {
  return fmt::format(
      "to {:.2g} % of a pixel's yield, rms; plain {:.2g} %: worth {:.2g} times the electrons",
      100 * gain.error_share, 100 * gain.plain_share, gain.electrons());
}

void print_summary(int threads, const workflow::SimulateSummary& s) {
  print_image(s);
  print_yields(s);
  if (s.charging) print_line("charging", workflow::describe(*s.charging));
  print_line("method", fmt::format("{}: {}", mc::name(s.choice.method), s.choice.reason));
  print_library(s);
  print_models(s);
  print_electrons(s);
  print_guided(s);
  print_speed(threads, s);
  print_simplified(s.simplification);
  if (s.scene.triangles_left_out > 0)
    print_line("triangles", fmt::format("{} that electrons can reach; {} left out",
                                        format_count(double(s.scene.triangles)),
                                        format_count(double(s.scene.triangles_left_out))));
  print_written(s.written);
}

}  // namespace surf::cli
