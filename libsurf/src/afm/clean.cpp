// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/clean.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "afm/ordered_window.h"
#include "afm/samples.h"
#include "core/argument.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr int largest_radius = 1000;
constexpr int rows_per_unit = 4;
constexpr std::uint32_t no_rank = std::numeric_limits<std::uint32_t>::max();

/// The rank of each sample by height, for samples that are not holes, and the heights by rank.
struct Ranks {
  std::vector<std::uint32_t> of;
  std::vector<double> heights;
};

Ranks rank(const HeightField& field) {
  Ranks r;
  std::vector<std::uint32_t> order;
  const std::vector<double>& z = field.z_nm.data();
  for (std::size_t i = 0; i < z.size(); ++i)
    if (field.valid.includes(i)) order.push_back(static_cast<std::uint32_t>(i));
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return z[a] != z[b] ? z[a] < z[b] : a < b; });
  r.of.assign(z.size(), no_rank);
  for (const std::uint32_t i : order) {
    r.of[i] = static_cast<std::uint32_t>(r.heights.size());
    r.heights.push_back(z[i]);
  }
  return r;
}

/// Half the width of the neighbourhood in each of its rows, dy = -radius ... radius.
std::vector<int> half_widths(const MedianOptions& o) {
  std::vector<int> out;
  for (int dy = -o.radius; dy <= o.radius; ++dy)
    out.push_back(o.neighbourhood == Neighbourhood::square
                      ? o.radius
                      : static_cast<int>(std::sqrt((o.radius + 0.5) * (o.radius + 0.5) - dy * dy)));
  return out;
}

/// The median around each sample of a row, from left to right; NaN if there are no samples around.
class RowMedians {
 public:
  RowMedians(const Ranks& ranks, int width, int height, const std::vector<int>& half_widths)
      : ranks_(ranks), width_(width), height_(height), half_widths_(half_widths),
        window_(ranks.heights.size()) {}

  void row(int y, double* out) {
    const int radius = static_cast<int>(half_widths_.size() / 2);
    const int first = std::max(-radius, -y), last = std::min(radius, height_ - 1 - y);
    const auto half = [&](int dy) { return half_widths_[static_cast<std::size_t>(dy + radius)]; };
    for (int dy = first; dy <= last; ++dy)
      for (int x = 0; x < std::min(half(dy), width_); ++x) add(x, y + dy);
    for (int x = 0; x < width_; ++x) {
      for (int dy = first; dy <= last; ++dy) {
        if (x + half(dy) < width_) add(x + half(dy), y + dy);
        if (x - half(dy) - 1 >= 0) remove(x - half(dy) - 1, y + dy);
      }
      out[x] = median();
    }
    for (int dy = first; dy <= last; ++dy)
      for (int x = std::max(0, width_ - 1 - half(dy)); x < width_; ++x) remove(x, y + dy);
  }

 private:
  std::uint32_t at(int x, int y) const {
    return ranks_.of[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x)];
  }
  void add(int x, int y) {
    if (at(x, y) != no_rank) window_.add(at(x, y));
  }
  void remove(int x, int y) {
    if (at(x, y) != no_rank) window_.remove(at(x, y));
  }
  double median() {
    const std::size_t n = window_.size();
    if (n == 0) return std::numeric_limits<double>::quiet_NaN();
    const double lower = ranks_.heights[window_.kth((n - 1) / 2)];
    if (n % 2) return lower;
    return lower + 0.5 * (ranks_.heights[window_.kth(n / 2)] - lower);
  }

  const Ranks& ranks_;
  int width_, height_;
  const std::vector<int>& half_widths_;
  OrderedWindow window_;
};

/// Applies the filtered heights (NaN: none) to the field and counts the changes.
Cleaned apply(const HeightField& field, const Grid<double>& filtered, double limit_nm,
              bool fill_holes) {
  Cleaned cleaned{field, {}};
  auto& [out, summary] = cleaned;
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    const double value = filtered.data()[i];
    double& z = out.z_nm.data()[i];
    if (!field.valid.empty() && !field.valid.data()[i]) {
      if (!fill_holes || !std::isfinite(value)) {
        ++summary.holes;
        continue;
      }
      out.valid.data()[i] = 1;
      ++summary.filled;
      z = value;
    } else if (value != z && (limit_nm == 0 || std::fabs(value - z) > limit_nm)) {
      ++summary.changed;
      z = value;
    }
  }
  return cleaned;
}

/// The running maximum over `width` values about each of `count` values that are `stride` apart
/// (van Herk, Gil and Werman), from maxima from the left and from the right within blocks of
/// `width`.
class RunningMaximum {
 public:
  explicit RunningMaximum(int width) : width_(static_cast<std::size_t>(width)) {}

  void run(double* line, std::size_t count, std::size_t stride) {
    const std::size_t half = width_ / 2;
    const std::size_t padded = (count + 2 * half + width_ - 1) / width_ * width_;
    constexpr double nothing = -std::numeric_limits<double>::infinity();
    from_left_.assign(padded, nothing);
    for (std::size_t i = 0; i < count; ++i) from_left_[half + i] = line[i * stride];
    from_right_ = from_left_;
    for (std::size_t i = 1; i < padded; ++i)
      if (i % width_) from_left_[i] = std::max(from_left_[i], from_left_[i - 1]);
    for (std::size_t i = padded - 1; i-- > 0;)
      if ((i + 1) % width_) from_right_[i] = std::max(from_right_[i], from_right_[i + 1]);
    for (std::size_t i = 0; i < count; ++i)
      line[i * stride] = std::max(from_right_[i], from_left_[i + width_ - 1]);
  }

 private:
  std::size_t width_;
  std::vector<double> from_left_, from_right_;
};

/// The maximum in the square about each sample; -infinity is ignored.
void square_maximum(Grid<double>& grid, int width, int threads, const Watch& watch) {
  const int workers = resolve_threads(threads);
  std::vector<RunningMaximum> runs(static_cast<std::size_t>(workers), RunningMaximum(width));
  const auto columns = static_cast<std::size_t>(grid.width()),
             rows = static_cast<std::size_t>(grid.height());
  double* const data = grid.data().data();
  parallel_for(
      rows, workers,
      [&](std::size_t y, int worker) {
        runs[static_cast<std::size_t>(worker)].run(data + y * columns, columns, 1);
      },
      watch.part(0, 0.5));
  parallel_for(
      columns, workers,
      [&](std::size_t x, int worker) {
        runs[static_cast<std::size_t>(worker)].run(data + x, rows, columns);
      },
      watch.part(0.5, 1));
}

}  // namespace

Cleaned median_filter(const HeightField& field, const MedianOptions& o) {
  validate(field);
  require_not_negative(o.limit_nm, "limit");
  if (o.radius < 0 || o.radius > largest_radius)
    throw UsageError("radius", fmt::format("it is {}", o.radius),
                     fmt::format("Give 0 to {}", largest_radius));
  const Ranks ranks = rank(field);
  const std::vector<int> widths = half_widths(o);
  const int width = field.z_nm.width(), height = field.z_nm.height();
  const int workers = resolve_threads(o.threads);
  std::vector<RowMedians> medians(static_cast<std::size_t>(workers),
                                  RowMedians(ranks, width, height, widths));
  Grid<double> filtered(width, height);
  parallel_for(
      static_cast<std::size_t>((height + rows_per_unit - 1) / rows_per_unit), workers,
      [&](std::size_t unit, int worker) {
        const int begin = static_cast<int>(unit) * rows_per_unit;
        for (int y = begin; y < std::min(height, begin + rows_per_unit); ++y)
          medians[static_cast<std::size_t>(worker)].row(y, &filtered(0, y));
      },
      o.watch);
  return apply(field, filtered, o.limit_nm, o.fill_holes);
}

Cleaned flat_closing(const HeightField& field, const ClosingOptions& o) {
  validate(field);
  if (o.width < 1 || o.width > 2 * largest_radius + 1 || o.width % 2 == 0)
    throw UsageError("width", fmt::format("it is {}", o.width),
                     fmt::format("Give an odd number from 1 to {}", 2 * largest_radius + 1));
  Grid<double> grid = field.z_nm;
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < field.valid.size(); ++i)
    if (!field.valid.data()[i]) grid.data()[i] = nothing;
  square_maximum(grid, o.width, o.threads, o.watch.part(0, 0.5));
  // The minimum of heights is minus the maximum of their negatives. Where there was no height
  // nearby, `nothing` stays.
  for (double& z : grid.data()) z = z == nothing ? nothing : -z;
  square_maximum(grid, o.width, o.threads, o.watch.part(0.5, 1));
  for (double& z : grid.data()) z = -z;
  return apply(field, grid, 0, o.fill_holes);
}

}  // namespace surf
