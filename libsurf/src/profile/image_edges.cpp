// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/image_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "surf/core/error.h"
#include "surf/core/sample_image.h"

namespace surf {
namespace {

constexpr double smooth_px = 1;
constexpr double least_rise = 0.25;  // of the strongest rim: what stands out less is none
constexpr double rim_reach_px = 3;   // what lies further from a rim's top is level ground

std::vector<double> smoothed(const std::vector<double>& y) {
  constexpr int reach = 3;
  std::vector<double> out(y.size());
  const auto n = static_cast<int>(y.size());
  for (int i = 0; i < n; ++i) {
    double sum = 0, weight = 0;
    for (int k = std::max(0, i - reach); k <= std::min(n - 1, i + reach); ++k) {
      if (!std::isfinite(y[static_cast<std::size_t>(k)])) continue;
      const double w = std::exp(-0.5 * (k - i) * (k - i) / (smooth_px * smooth_px));
      sum += w * y[static_cast<std::size_t>(k)], weight += w;
    }
    out[static_cast<std::size_t>(i)] = weight > 0 ? sum / weight
                                       : i > 0    ? out[static_cast<std::size_t>(i) - 1]
                                                  : 0;
  }
  return out;
}

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

/// The mean of all rows, by column.
std::vector<double> mean_row(const PlacedImage& image) {
  const Grid<double>& v = image.values;
  std::vector<double> out(static_cast<std::size_t>(v.width()), 0);
  for (int x = 0; x < v.width(); ++x) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < v.height(); ++y)
      if (image.is_valid(x, y)) sum += v(x, y), ++count;
    out[static_cast<std::size_t>(x)] =
        count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

/// By how much a place rises above what separates it from higher ones, on the shallower side.
double prominence(const std::vector<double>& y, std::size_t i) {
  double saddle = -HUGE_VAL;
  for (const int step : {-1, 1}) {
    double least = y[i];
    for (auto k = static_cast<std::ptrdiff_t>(i);
         k >= 0 && k < std::ssize(y) && y[static_cast<std::size_t>(k)] <= y[i]; k += step)
      least = std::min(least, y[static_cast<std::size_t>(k)]);
    saddle = std::max(saddle, least);
  }
  return y[i] - saddle;
}

/// Tops of bright rims: maxima that stand out by a share of how far the highest does from the level
/// of the image. Level tops of features may be as bright as that, but do not stand out.
std::vector<int> rims(const std::vector<double>& y) {
  const double level = median(y), highest = *std::ranges::max_element(y);
  std::vector<int> tops;
  for (std::size_t i = 1; i + 1 < y.size(); ++i)
    if (y[i] > y[i - 1] && y[i] >= y[i + 1] && y[i] > level &&
        prominence(y, i) > least_rise * (highest - level))
      tops.push_back(static_cast<int>(i));
  return tops;
}

struct Flank {
  int top, ground_end;  // columns: the rim's top, the end of its ground, on the side of the ground
  int left, right;      // its own columns
};

/// Where the signal crosses the threshold between the rim's top and the ground; NaN if nowhere.
double crossing(const std::vector<double>& y, const Flank& f, double threshold) {
  const int step = f.ground_end < f.top ? -1 : 1;
  std::vector<double> ground;
  for (int i = f.top + step * static_cast<int>(rim_reach_px); i != f.ground_end; i += step) {
    if (i < 0 || i >= static_cast<int>(y.size()) || (f.ground_end - i) * step <= 0) break;
    ground.push_back(y[static_cast<std::size_t>(i)]);
  }
  if (ground.empty()) ground.push_back(y[static_cast<std::size_t>(f.ground_end)]);
  const double low = median(ground), high = y[static_cast<std::size_t>(f.top)],
               level = low + threshold * (high - low);
  for (int i = f.top; i != f.ground_end; i += step) {
    const double a = y[static_cast<std::size_t>(i)], b = y[static_cast<std::size_t>(i + step)];
    if (a >= level && b < level) return i + step * (a - level) / (a - b);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The level of the signal beside a rim, beyond its slope.
double level_beside(const std::vector<double>& y, int top, int end) {
  const int step = end < top ? -1 : 1;
  std::vector<double> values;
  for (int i = top + step * static_cast<int>(rim_reach_px); (end - i) * step >= 0; i += step)
    values.push_back(y[static_cast<std::size_t>(i)]);
  return values.empty() ? y[static_cast<std::size_t>(end)] : median(values);
}

struct Rim {
  int top, left, right;  // its own columns, from the middle to the rim before to that to the next
  bool material_right;
};

/// Whether the image ends within some reaches of a rim, so that it hardly shows what lies beside
/// it.
bool cut_off(int top, const std::vector<double>& y, double reaches) {
  const double seen = reaches * rim_reach_px;
  return top <= seen || top >= static_cast<double>(y.size()) - 1 - seen;
}

/// How much brighter material is than ground beside rims that the image shows well; 0: none does.
double material_above_ground(const std::vector<Rim>& rims, const std::vector<double>& y) {
  std::vector<double> steps;
  for (const Rim& r : rims)
    if (!cut_off(r.top, y, 2))
      steps.push_back(std::abs(level_beside(y, r.top, r.right) - level_beside(y, r.top, r.left)));
  return median(steps);
}

/// Rims, and on which side of each the material is: the ground beside a wall is darker. Of a rim at
/// the image's end hardly more is seen than the rim. Where its own levels differ clearly they tell
/// its side, else that material and ground take turns, which fails where a rim between is too faint
/// to be found.
std::vector<Rim> rims_of(const std::vector<double>& y) {
  const std::vector<int> tops = rims(y);
  std::vector<Rim> out;
  for (std::size_t i = 0; i < tops.size(); ++i) {
    const int left = i == 0 ? 0 : (tops[i - 1] + tops[i]) / 2,
              right = i + 1 == tops.size() ? static_cast<int>(y.size()) - 1
                                           : (tops[i] + tops[i + 1]) / 2;
    out.push_back(
        {tops[i], left, right, level_beside(y, tops[i], left) < level_beside(y, tops[i], right)});
  }
  if (out.size() > 1) {
    const double clear = 0.5 * material_above_ground(out, y);
    const auto turn = [&](Rim& rim, const Rim& neighbour) {
      if (!cut_off(rim.top, y, 2)) return;
      const double step = level_beside(y, rim.top, rim.right) - level_beside(y, rim.top, rim.left);
      if (cut_off(rim.top, y, 1) || !(std::abs(step) > clear) || clear == 0)
        rim.material_right = !neighbour.material_right;
    };
    turn(out.front(), out[1]);
    turn(out.back(), out[out.size() - 2]);
  }
  return out;
}

/// Rims by feature: a pair around material or a gap, or one of edges.
std::vector<std::vector<Rim>> features_of(const std::vector<Rim>& all, FeatureKind kind,
                                          const std::vector<double>& y) {
  std::vector<std::vector<Rim>> out;
  std::vector<Rim> rims;
  for (const Rim& r : all)
    if (!cut_off(r.top, y, 1)) rims.push_back(r);
  if (kind == FeatureKind::edge || kind == FeatureKind::hole) {
    for (const Rim& r : rims) out.push_back({r});
    return out;
  }
  const bool line = kind == FeatureKind::line;
  for (std::size_t i = 0; i + 1 < rims.size(); ++i)
    if (rims[i].material_right == line && rims[i + 1].material_right != line)
      out.push_back({rims[i], rims[i + 1]}), ++i;
  return out;
}

/// The brightest place of a rim, between columns.
double top_of(const Rim& rim, const std::vector<double>& y) {
  const auto i = static_cast<std::size_t>(rim.top);  // never the first or last
  const double bend = y[i - 1] - 2 * y[i] + y[i + 1];
  return rim.top + (bend < 0 ? 0.5 * (y[i - 1] - y[i + 1]) / bend : 0);
}

/// Rims beyond the first and the last feature, as long as material and ground take turns.
std::vector<Rim> cut_off_rims(const std::vector<Rim>& rims,
                              const std::vector<std::vector<Rim>>& features) {
  std::vector<Rim> out;
  const auto add = [&](auto begin, auto end, Rim last, bool left) {
    for (auto rim = begin; rim != end; ++rim) {
      if (left ? rim->top >= last.top : rim->top <= last.top) continue;
      if (rim->material_right == last.material_right) break;
      out.push_back(last = *rim);
    }
  };
  add(rims.rbegin(), rims.rend(), features.front().front(), true);
  std::ranges::reverse(out);
  add(rims.begin(), rims.end(), features.back().back(), false);
  return out;
}

/// See ThresholdEdges; in columns.
double pitch_of(const std::vector<Rim>& rims, const std::vector<double>& y, double threshold) {
  constexpr double most_uneven = 1.15;
  std::vector<double> distances;
  for (const bool right : {false, true}) {
    double before = std::nan("");
    for (const Rim& rim : rims) {
      if (rim.material_right != right) continue;
      const double place =
          crossing(y, {rim.top, right ? rim.left : rim.right, rim.left, rim.right}, threshold);
      if (std::isfinite(place - before)) distances.push_back(place - before);
      before = place;
    }
  }
  if (distances.empty()) return 0;
  const auto [least, most] = std::ranges::minmax(distances);
  if (most > most_uneven * least) return 0;
  return std::accumulate(distances.begin(), distances.end(), 0.0) /
         static_cast<double>(distances.size());
}

}  // namespace

ThresholdEdges find_edges(const PlacedImage& image, FeatureKind kind, double threshold) {
  const std::vector<double> mean = smoothed(mean_row(image));
  ThresholdEdges out;
  std::vector<Flank> flanks;
  const std::vector<Rim> rims = rims_of(mean);
  const auto features = features_of(rims, kind, mean);
  if (kind == FeatureKind::line || kind == FeatureKind::trench)
    out.pitch_nm = image.pitch_x_nm * pitch_of(rims, mean, threshold);
  const auto rim_nm = [&](const Rim& rim) {
    return image.x_nm(0) + top_of(rim, mean) * image.pitch_x_nm;
  };
  for (std::size_t f = 0; f < features.size(); ++f)
    for (const Rim& rim : features[f]) {
      const Flank flank{rim.top, rim.material_right ? rim.left : rim.right, rim.left, rim.right};
      const double column = crossing(mean, flank, threshold);
      if (!std::isfinite(column)) continue;
      flanks.push_back(flank);
      out.edges.push_back({static_cast<int>(f), rim.material_right,
                           image.x_nm(0) + column * image.pitch_x_nm, image.x_nm(rim.left),
                           image.x_nm(rim.right), rim_nm(rim)});
    }
  if (out.edges.empty())
    throw InvalidInput("SEM image",
                       fmt::format("no {} is seen: no bright rims with darker ground at {} side "
                                   "stand out",
                                   name(kind),
                                   kind == FeatureKind::edge   ? "one"
                                   : kind == FeatureKind::line ? "the outer"
                                                               : "the inner"),
                       kind == FeatureKind::hole
                           ? "Check what the image shows"
                           : "Check what the image shows; lines must run along y");
  for (const Rim& rim : cut_off_rims(rims, features))
    out.cut_off.push_back({rim.material_right, rim_nm(rim)});
  out.places_nm.resize(out.edges.size());
  for (int y = 0; y < image.values.height(); ++y) {
    out.rows_nm.push_back(image.y_nm(y));
    std::vector<double> row;
    for (int x = 0; x < image.values.width(); ++x)
      row.push_back(image.is_valid(x, y) ? image.values(x, y)
                                         : std::numeric_limits<double>::quiet_NaN());
    row = smoothed(row);
    for (std::size_t e = 0; e < flanks.size(); ++e) {
      // The rim's top of this row.
      const int reach = static_cast<int>(2 * rim_reach_px);
      Flank flank = flanks[e];
      for (int x = std::max(flank.left, flanks[e].top - reach);
           x <= std::min(flank.right, flanks[e].top + reach); ++x)
        if (row[static_cast<std::size_t>(x)] > row[static_cast<std::size_t>(flank.top)])
          flank.top = x;
      const double column =
          flank.top == flank.ground_end ? std::nan("") : crossing(row, flank, threshold);
      out.places_nm[e].push_back(image.x_nm(0) + column * image.pitch_x_nm);
    }
  }
  return out;
}

double room_about(const PlacedImage& image, const Circle& hole) {
  const Grid<double>& v = image.values;
  return std::min({hole.x_nm - image.x_nm(0), image.x_nm(v.width() - 1) - hole.x_nm,
                   hole.y_nm - image.y_nm(0), image.y_nm(v.height() - 1) - hole.y_nm});
}

Circle find_hole(const PlacedImage& image) {
  const Grid<double>& v = image.values;
  const InvalidInput none(
      "SEM image", "no hole is seen: no dark part has a bright rim around it",
      "Check what the image shows; the hole and its surroundings must be in it");
  // The darkest place, over an eighth of the image.
  const int half = std::max(2, std::min(v.width(), v.height()) / 16);
  double least = HUGE_VAL;
  int dark_x = 0, dark_y = 0;
  for (int y = half; y < v.height() - half; ++y)
    for (int x = half; x < v.width() - half; ++x) {
      double sum = 0;
      int count = 0, all = 0;
      for (int dy = -half; dy <= half; dy += std::max(1, half / 4))
        for (int dx = -half; dx <= half; dx += std::max(1, half / 4), ++all)
          if (image.is_valid(x + dx, y + dy)) sum += v(x + dx, y + dy), ++count;
      if (2 * count > all && sum / count < least) least = sum / count, dark_x = x, dark_y = y;
    }
  Circle circle{image.x_nm(dark_x), image.y_nm(dark_y), 0};
  // The brightest places on rays from there lie on the rim; a circle through them, repeated.
  constexpr int rounds = 12, rough_rounds = 8;  // from far off the middle all points count
  for (int round = 0; round < rounds; ++round) {
    constexpr int rays = 90;
    const double step = 0.5 * image.pitch_x_nm;
    std::vector<Point2> rim;
    std::vector<double> distances;
    for (int k = 0; k < rays; ++k) {
      const double a = 2 * std::numbers::pi * k / rays;
      double best = -HUGE_VAL, at = 0;
      for (double r = 2 * image.pitch_x_nm;; r += step) {
        const Point2 p{circle.x_nm + r * std::cos(a), circle.y_nm + r * std::sin(a)};
        if (!(p.x > image.x_nm(1) && p.x < image.x_nm(v.width() - 2) && p.y > image.y_nm(1) &&
              p.y < image.y_nm(v.height() - 2)))
          break;
        const double value = sample_image(image, p);
        if (value > best) best = value, at = r;
      }
      if (at > 0) {
        distances.push_back(at);
        rim.push_back({circle.x_nm + at * std::cos(a), circle.y_nm + at * std::sin(a)});
      }
    }
    if (distances.size() < rays / 2) throw none;
    const double radius = median(distances);
    Circle next{0, 0, 0};
    double count = 0;
    // The mean of opposite points cancels what lies between rays.
    for (std::size_t k = 0; k < rim.size(); ++k)
      if (round < rough_rounds || std::abs(distances[k] - radius) < 0.25 * radius)
        next.x_nm += rim[k].x, next.y_nm += rim[k].y, next.radius_nm += distances[k], ++count;
    if (count < rays / 3.0) throw none;
    circle = {next.x_nm / count, next.y_nm / count, next.radius_nm / count};
  }
  if (!(room_about(image, circle) > circle.radius_nm + 3 * image.pitch_x_nm)) throw none;
  return circle;
}

PlacedImage unrolled(const PlacedImage& image, const Circle& hole) {
  const double step = image.pitch_x_nm;
  const int columns = std::max(4, static_cast<int>(std::floor(room_about(image, hole) / step)));
  const int rows =
      std::max(16, static_cast<int>(std::lround(2 * std::numbers::pi * hole.radius_nm / step)));
  PlacedImage out;
  out.pitch_x_nm = step;
  out.pitch_y_nm = 2 * std::numbers::pi * hole.radius_nm / rows;
  out.values = Grid<double>(columns, rows);
  out.valid = Mask(columns, rows, 1);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double a = 2 * std::numbers::pi * y / rows, r = x * step;
      out.values(x, y) =
          sample_image(image, {hole.x_nm + r * std::cos(a), hole.y_nm + r * std::sin(a)});
      if (!std::isfinite(out.values(x, y))) out.values(x, y) = 0, out.valid(x, y) = 0;
    }
  return out;
}

}  // namespace surf
