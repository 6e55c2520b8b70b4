// SPDX-License-Identifier: GPL-3.0-or-later
#include "edge_places.h"

#include <cmath>
#include <vector>

namespace surf::workflow {
namespace {

constexpr double least_rise_nm = 10;
constexpr int farthest_px = 6;

/// Heights along a row or a column.
struct Line {
  std::vector<double> truth_nm = {}, surface_nm = {}, deviation_nm = {}, lower_nm = {},
                      upper_nm = {};
  double pitch_nm = 1;
};

/// Where heights pass a level between samples `i` and `i + 1`, rising or falling as asked; nothing
/// if they do not.
std::optional<double> passes(const std::vector<double>& z, std::size_t i, double level_nm,
                             bool rising) {
  const double a = z[i] - level_nm, b = z[i + 1] - level_nm;
  if (rising ? !(a < 0 && b >= 0) : !(a >= 0 && b < 0)) return std::nullopt;
  return static_cast<double>(i) + a / (a - b);
}

double between(const std::vector<double>& z, double place) {
  const auto i = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(i);
  return i + 1 < z.size() ? (1 - share) * z[i] + share * z[i + 1] : z.back();
}

void count(double off_nm, double stated_nm, RegionReport& report) {
  ++report.pixels;
  report.rms_nm += off_nm * off_nm;
  report.stated_nm += stated_nm * stated_nm;
  report.coverage_1 += off_nm <= stated_nm;
  report.coverage_2 += off_nm <= 2 * stated_nm;
}

void judge_wall(const Line& line, std::size_t begin, std::size_t end, RegionReport& report) {
  const double low = line.truth_nm[begin], high = line.truth_nm[end], level = 0.5 * (low + high);
  const bool rising = high > low;
  std::optional<double> true_place;
  for (std::size_t i = begin; i < end && !true_place; ++i)
    true_place = passes(line.truth_nm, i, level, rising);
  if (!true_place) return;
  double off = farthest_px, stated = 0;
  bool found = false;
  for (std::size_t i = 0; i + 1 < line.surface_nm.size(); ++i) {
    const auto place = passes(line.surface_nm, i, level, rising);
    if (!place || std::abs(*place - *true_place) >= off) continue;
    found = true;
    off = std::abs(*place - *true_place);
    const double slope = std::abs(line.surface_nm[i + 1] - line.surface_nm[i]);
    stated = between(line.deviation_nm, *place) / slope;  // pixels
  }
  count(off * line.pitch_nm, found ? stated * line.pitch_nm : 0, report);
  if (!line.lower_nm.empty())
    report.in_interval += between(line.lower_nm, *true_place) <= level &&
                          between(line.upper_nm, *true_place) >= level;
}

void judge(const Line& line, RegionReport& report) {
  const auto rise = [&](std::size_t i) { return line.truth_nm[i + 1] - line.truth_nm[i]; };
  const std::size_t steps = line.truth_nm.size() - 1;
  for (std::size_t i = 0; i < steps;) {
    if (!(std::abs(rise(i)) > wall_slope * line.pitch_nm)) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < steps && std::abs(rise(end)) > wall_slope * line.pitch_nm &&
           rise(end) * rise(i) > 0)
      ++end;
    if (std::abs(line.truth_nm[end] - line.truth_nm[i]) >= least_rise_nm)
      judge_wall(line, i, end, report);
    i = end;
  }
}

}  // namespace

RegionReport edge_places(const Reconstruction& result, const HeightField& truth, double offset_nm) {
  RegionReport report;
  report.name = "edge";
  const HeightField& s = result.surface;
  const int w = s.z_nm.width(), h = s.z_nm.height();
  const auto add = [&](Line& line, int x, int y) {
    if (s.is_valid(x, y) && truth.is_valid(x, y)) {
      line.truth_nm.push_back(truth.z_nm(x, y));
      line.surface_nm.push_back(s.z_nm(x, y) - offset_nm);
      line.deviation_nm.push_back(result.deviation_nm(x, y));
      if (!result.lower_nm.empty()) {
        line.lower_nm.push_back(result.lower_nm(x, y) - offset_nm);
        line.upper_nm.push_back(result.upper_nm(x, y) - offset_nm);
      }
      return;
    }
    if (line.truth_nm.size() > 1) judge(line, report);
    line = Line{.pitch_nm = line.pitch_nm};
  };
  for (int y = 0; y < h; ++y) {
    Line line{.pitch_nm = s.pitch_x_nm};
    for (int x = 0; x < w; ++x) add(line, x, y);
    if (line.truth_nm.size() > 1) judge(line, report);
  }
  for (int x = 0; x < w; ++x) {
    Line line{.pitch_nm = s.pitch_y_nm};
    for (int y = 0; y < h; ++y) add(line, x, y);
    if (line.truth_nm.size() > 1) judge(line, report);
  }
  if (report.pixels == 0) return report;
  const auto n = static_cast<double>(report.pixels);
  report.rms_nm = std::sqrt(report.rms_nm / n);
  report.stated_nm = std::sqrt(report.stated_nm / n);
  report.coverage_1 /= n;
  report.coverage_2 /= n;
  report.in_interval /= n;
  return report;
}

}  // namespace surf::workflow
