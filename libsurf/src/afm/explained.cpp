// SPDX-License-Identifier: GPL-3.0-or-later
#include "explained.h"

#include <algorithm>
#include <limits>

#include "surf/core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "afm/explained.cpp"
#include "core/each_target.h"

#ifndef SEMSURF_EXPLAINED_TYPES
#define SEMSURF_EXPLAINED_TYPES
namespace surf {

// Rows of the result and samples of a row of the tip per pass, so that each vector that is loaded
// serves many sums.
constexpr int rows_together = 2;
constexpr int together = 4;

/// What successive heights of a row add to the rows of the result.
struct Samples {
  int row, column;  ///< of the first height; 0: those of the result
  float offset[rows_together][together];
  float most;  ///< the largest of them
};

/// Where a row of the result begins, in what the tip meets.
struct MetRow {
  const float* z;
  std::ptrdiff_t stride;
  const float* bound;  ///< of the columns from each 16th on, for as many as a block can meet
  std::ptrdiff_t bound_stride;
  int column;  ///< of z
};

constexpr int lanes = 16;  // of the widest vectors
constexpr int block = 64;  // columns that share a bound
constexpr int spans =
    (block + together + 2 * lanes - 3) / lanes;  // sixteenths that a block can meet

}  // namespace surf
#endif

HWY_BEFORE_NAMESPACE();
namespace surf::HWY_NAMESPACE {

// out(x) = max(out(x), in(x + k) + offset[k] of four), for two rows; -infinity + infinity does not
// count.
HWY_INLINE void raise_to(float* __restrict out, float* __restrict next, const float* __restrict in,
                         const float (&offset)[rows_together][together], int count) {
  const float a = offset[0][0], b = offset[0][1], c = offset[0][2], d = offset[0][3];
  const float e = offset[1][0], f = offset[1][1], g = offset[1][2], h = offset[1][3];
  for (int x = 0; x < count; ++x) {
    float most = out[x], more = next[x];
    const float z0 = in[x], z1 = in[x + 1], z2 = in[x + 2], z3 = in[x + 3];
    most = z0 + a > most ? z0 + a : most;
    more = z0 + e > more ? z0 + e : more;
    most = z1 + b > most ? z1 + b : most;
    more = z1 + f > more ? z1 + f : more;
    most = z2 + c > most ? z2 + c : most;
    more = z2 + g > more ? z2 + g : more;
    most = z3 + d > most ? z3 + d : most;
    more = z3 + h > more ? z3 + h : more;
    out[x] = most;
    next[x] = more;
  }
}

HWY_INLINE float least_of(const float* z, int count) {
  float least = z[0];
  for (int x = 1; x < count; ++x) least = z[x] < least ? z[x] : least;
  return least;
}

// Raises two rows of the result, and skips samples that cannot exceed what is there already. The
// result is written up to the end of the last vector; of the second row only if it is wanted.
void raise_rows(float* const (&out)[rows_together], int rows, int width, const MetRow& met,
                const Samples* samples, int count) {
  for (int x = 0; x < width; x += block) {
    const int wanted = width - x < block ? width - x : block;
    const int whole = (wanted + lanes - 1) / lanes * lanes;
    float floor = -std::numeric_limits<float>::infinity();
    int done = 0;
    for (int n = 0; n < count; ++n) {
      const Samples& s = samples[n];
      const float bound = met.bound[s.row * met.bound_stride + (met.column + x + s.column) / lanes];
      if (bound + s.most <= floor) continue;
      const float* const in = met.z + s.row * met.stride + s.column + x;
      if (whole == block) raise_to(out[0] + x, out[1] + x, in, s.offset, block);
      else raise_to(out[0] + x, out[1] + x, in, s.offset, whole);
      if (++done % 8 != 1) continue;
      floor = least_of(out[0] + x, wanted);
      if (rows > 1) floor = std::min(floor, least_of(out[1] + x, wanted));
    }
  }
}

}  // namespace surf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf {
namespace {

HWY_EXPORT(raise_rows);

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Heights that a tip meets, laid out like a scan, and upper bounds of them.
class Met {
 public:
  Met(const CarvedScan& scan, const float* z) : scan_(scan), z_(z) {
    const auto rows = static_cast<std::ptrdiff_t>(scan.size()) / scan.stride();
    bound_stride_ = (scan.stride() + lanes - 1) / lanes;
    bounds_.resize(static_cast<std::size_t>(rows * bound_stride_));
    std::vector<float> most(static_cast<std::size_t>(bound_stride_));
    for (std::ptrdiff_t y = 0; y < rows; ++y) {
      const float* const row = z + y * scan.stride();
      for (std::ptrdiff_t b = 0; b < bound_stride_; ++b)
        most[static_cast<std::size_t>(b)] = *std::max_element(
            row + b * lanes, row + std::min<std::ptrdiff_t>((b + 1) * lanes, scan.stride()));
      for (std::ptrdiff_t b = 0; b < bound_stride_; ++b)
        bounds_[static_cast<std::size_t>(y * bound_stride_ + b)] = *std::max_element(
            most.begin() + b, most.begin() + std::min<std::ptrdiff_t>(b + spans, bound_stride_));
    }
  }

  MetRow at(int x, int y) const {
    const auto place = static_cast<std::ptrdiff_t>(scan_.offset(x, y));
    return {z_ + place, scan_.stride(), bounds_.data() + place / scan_.stride() * bound_stride_,
            bound_stride_, static_cast<int>(place % scan_.stride())};
  }

 private:
  const CarvedScan& scan_;
  const float* z_;
  std::ptrdiff_t bound_stride_ = 0;
  std::vector<float> bounds_;
};

/// What heights add to rows of the result, the most first. `sign` 1: each sample of the tip, less
/// its threshold, meets what lies as far from the result as the sample from the apex; -1: on the
/// other side, with no threshold.
std::vector<Samples> samples_of(const CarvedTip& tip, int sign) {
  const auto offset = [&](int i, int j) {
    if (i < 0 || i >= tip.width || j < 0 || j >= tip.height) return -infinity;
    const auto at = static_cast<std::size_t>(j * tip.stride + i);
    return sign < 0 ? tip.z[at] : tip.z[at] - tip.threshold[at];
  };
  const int reach = tip.height + rows_together;
  std::vector<Samples> out;
  for (int row = -reach; row <= reach; ++row)
    for (int first = 0; first < tip.width; first += together) {
      // Columns of the tip run against those of the heights if the sign is -1.
      const int begin = sign > 0 ? first : first + together - 1;
      Samples s{row, sign * (begin - tip.apex_x), {}, -infinity};
      for (int r = 0; r < rows_together; ++r)
        for (int k = 0; k < together; ++k) {
          s.offset[r][k] = offset(begin + sign * k, tip.apex_y + sign * (row - r));
          s.most = std::max(s.most, s.offset[r][k]);
        }
      if (s.most > -infinity) out.push_back(s);
    }
  std::stable_sort(out.begin(), out.end(),
                   [](const Samples& a, const Samples& b) { return a.most > b.most; });
  return out;
}

/// Calls `work(y)` for each `rows_together`-th row.
template <class Work>
void each_pair(int begin, int end, int threads, const Work& work) {
  parallel_for(
      static_cast<std::size_t>((end - begin + rows_together - 1) / rows_together), threads,
      [&](std::size_t unit, int) { work(begin + static_cast<int>(unit) * rows_together); });
}

}  // namespace

std::vector<float> apex_heights(const CarvedScan& scan, const CarvedTip& tip, int threads) {
  // A minimum is a maximum of what is upside down.
  std::vector<float> top(scan.size()), apex(scan.size(), -infinity);
  std::transform(scan.tops(), scan.tops() + top.size(), top.begin(), [](float z) { return -z; });
  const Met met(scan, top.data());
  const std::vector<Samples> samples = samples_of(tip, 1);
  // The apex may lie outside the scan by the size of the tip.
  const int left = tip.width - 1 - tip.apex_x, below = tip.height - 1 - tip.apex_y;
  const int w = scan.width() + tip.width - 1, end = scan.height() + tip.apex_y;
  each_pair(-below, end, threads, [&](int y) {
    // Beyond the end there is a row of the margin.
    float* const rows[] = {apex.data() + scan.offset(-left, y),
                           apex.data() + scan.offset(-left, y + 1)};
    HWY_DYNAMIC_DISPATCH(raise_rows)
    (rows, end - y, w, met.at(-left, y), samples.data(), static_cast<int>(samples.size()));
  });
  for (float& z : apex) z = -z;
  return apex;
}

Grid<float> explained_height(const CarvedScan& scan, const std::vector<float>& apex,
                             const CarvedTip& tip, int threads) {
  const Met met(scan, apex.data());
  const std::vector<Samples> samples = samples_of(tip, -1);
  const int w = scan.width();
  Grid<float> out(w, scan.height());
  each_pair(0, scan.height(), threads, [&](int y) {
    const auto wide = static_cast<std::size_t>(w + lanes);
    std::vector<float> raised(rows_together * wide, -infinity);
    float* const rows[] = {raised.data(), raised.data() + wide};
    const int wanted = std::min(rows_together, scan.height() - y);
    HWY_DYNAMIC_DISPATCH(raise_rows)
    (rows, wanted, w, met.at(0, y), samples.data(), static_cast<int>(samples.size()));
    for (int r = 0; r < wanted; ++r) std::copy_n(rows[r], w, &out(0, y + r));
  });
  return out;
}

}  // namespace surf
#endif
