// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "compare/compare_steps.h"

namespace surf::workflow {
namespace {

using io::PlotColors;
using io::PlotPanel;

constexpr double blank = std::numeric_limits<double>::quiet_NaN();
constexpr double deviations_shown = 6;
constexpr std::size_t most_numbers = 12;  // of places, written into the picture
constexpr int up = 4, down = 5;           // colours of outlines: orange and light blue

/// Lengths of the axes: um for wide views.
struct Scale {
  double per_nm = 1;
  const char* unit = "nm";
};
Scale scale_of(const PlacedImage& image) {
  constexpr double wide_nm = 3000;
  const double width = image.values.width() * image.pitch_x_nm;
  return width > wide_nm ? Scale{1e-3, "µm"} : Scale{};
}

PlotPanel picture(const std::string& title, const Placement& at, Grid<double> values,
                  const Mask& valid, PlotColors colors, const std::string& label, Scale scale) {
  PlotPanel panel;
  panel.title = title;
  panel.x.label = fmt::format("x ({})", scale.unit);
  panel.y.label = fmt::format("y ({})", scale.unit);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!valid.includes(i)) values.data()[i] = blank;
  io::PlotImage image;
  image.values = std::move(values);
  image.pitch_x = at.pitch_x_nm * scale.per_nm, image.pitch_y = at.pitch_y_nm * scale.per_nm;
  image.origin_x = at.origin_x_nm * scale.per_nm, image.origin_y = at.origin_y_nm * scale.per_nm;
  image.colors = colors;
  image.label = label;
  image.lit_per_unit = scale.per_nm;
  panel.image = std::move(image);
  return panel;
}

/// The borders of places as closed lines along the edges of samples, each with its place's number.
/// Places lie at the left of their lines.
std::vector<std::pair<int, std::vector<std::pair<int, int>>>> borders_of(const Grid<int>& place) {
  using Corner = std::pair<int, int>;
  const int w = place.width(), h = place.height();
  const auto at = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < w && y < h ? place(x, y) : 0;
  };
  std::map<std::pair<int, Corner>, std::vector<Corner>> next;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int own = place(x, y);
      if (own == 0) continue;
      if (at(x, y - 1) != own) next[{own, {x, y}}].push_back({x + 1, y});
      if (at(x + 1, y) != own) next[{own, {x + 1, y}}].push_back({x + 1, y + 1});
      if (at(x, y + 1) != own) next[{own, {x + 1, y + 1}}].push_back({x, y + 1});
      if (at(x - 1, y) != own) next[{own, {x, y + 1}}].push_back({x, y});
    }
  std::vector<std::pair<int, std::vector<Corner>>> lines;
  while (!next.empty()) {
    const auto [number, start] = next.begin()->first;
    std::vector<Corner> line{start};
    do {
      const auto step = next.find({number, line.back()});
      if (step == next.end()) break;
      line.push_back(step->second.back());
      step->second.pop_back();
      if (step->second.empty()) next.erase(step);
    } while (line.back() != start);
    lines.emplace_back(number, std::move(line));
  }
  return lines;
}

/// The corners of samples lie half a sample before them.
void outline_places(PlotPanel& panel, const CompareSummary& s, Scale scale, bool numbers) {
  const Placement& at = s.difference.placement();
  for (const auto& [number, line] : borders_of(s.changes.place)) {
    io::PlotSeries series;
    for (const auto& [x, y] : line) {
      series.x.push_back(at.x_nm(x - 0.5) * scale.per_nm);
      series.y.push_back(at.y_nm(y - 0.5) * scale.per_nm);
    }
    series.color = s.changes.places[static_cast<std::size_t>(number) - 1].mean > 0 ? up : down;
    panel.series.push_back(std::move(series));
  }
  panel.legend = false;
  if (!numbers) return;
  for (std::size_t k = 0; k < std::min(most_numbers, s.changes.places.size()); ++k) {
    const ChangedPlace& place = s.changes.places[k];
    panel.notes.push_back({std::to_string(k + 1), place.centre_nm.x * scale.per_nm,
                           place.centre_nm.y * scale.per_nm});
  }
}

/// The range of heights of both pictures, so that they have the same colours.
io::PlotAxis::Range common_range(const PlacedImage& a, const PlacedImage& b) {
  std::vector<double> all;
  for (const PlacedImage* image : {&a, &b})
    for (std::size_t i = 0; i < image->values.size(); ++i)
      if (image->valid.includes(i)) all.push_back(image->values.data()[i]);
  std::ranges::sort(all);
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  const double low = at(0.005), high = at(0.995);
  return high > low ? io::PlotAxis::Range{low, high} : io::PlotAxis::Range{low - 1, low + 1};
}

std::string title_of(const CompareJob& job, const CompareSummary& s) {
  const std::string files =
      job.before_file.filename().string() + " and " + job.after_file.filename().string();
  if (s.changes.places.empty()) return files + ": no change beyond the errors";
  const ChangedPlace& first = s.changes.places.front();
  return fmt::format("{}: {} changed place{}; the clearest by {:+.2g} ± {:.1g} {}", files,
                     s.changes.places.size(), s.changes.places.size() == 1 ? "" : "s", first.mean,
                     first.mean_error, s.unit);
}

}  // namespace

io::Plot compare_picture(const CompareJob& job, const CompareSummary& s) {
  const Scale scale = scale_of(s.before);
  const Placement& at = s.difference.placement();
  const Mask& valid = s.difference.valid;
  const bool image = job.of_image();
  const PlotColors look = image ? PlotColors::grey : PlotColors::relief;
  const std::string unit = image ? "grey level" : "nm";
  PlotPanel before = picture(image ? "SEM image that the surface before predicts" : "before", at,
                             s.before.values, valid, look, unit, scale);
  PlotPanel after = picture(image ? "SEM image after" : "after, moved onto it", at, s.after.values,
                            valid, look, unit, scale);
  before.image->range = after.image->range = common_range(s.before, s.after);
  Grid<double> ratio = s.difference.difference;
  for (std::size_t i = 0; i < ratio.size(); ++i)
    if (valid.includes(i)) ratio.data()[i] /= s.changes.deviation.data()[i];
  PlotPanel difference = picture("after less before, over its standard deviation", at, ratio, valid,
                                 PlotColors::difference, "standard deviations", scale);
  difference.image->range = io::PlotAxis::Range{-deviations_shown, deviations_shown};
  PlotPanel probability = picture(fmt::format("probability of a change, outlined above {:g} %",
                                              100 * (1 - job.parameters.false_alarms)),
                                  at, s.changes.probability, valid, PlotColors::heights,
                                  "1 − p, for the whole view", scale);
  probability.image->range = io::PlotAxis::Range{0, 1};
  outline_places(after, s, scale, false);
  outline_places(difference, s, scale, true);
  outline_places(probability, s, scale, false);
  io::Plot plot;
  plot.title = title_of(job, s);
  plot.panels = {std::move(before), std::move(after), std::move(difference),
                 std::move(probability)};
  plot.columns = 2;
  plot.width_px = 1600;
  return plot;
}

}  // namespace surf::workflow
