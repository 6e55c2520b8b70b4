// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_carver.h"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "afm/tip_carver.cpp"
#include "core/each_target.h"

#ifndef SEMSURF_TIP_CARVER_WORK
#define SEMSURF_TIP_CARVER_WORK
namespace surf {
namespace {

/// One point of a scan, and space to work in.
struct CarverWork {
  const float* mirrored;  ///< samples of the tip, each row reversed
  const float* scan;      ///< where the point lies
  const float* apex;      ///< the same place in the heights of the apex
  std::ptrdiff_t scan_stride;
  float here, tolerance;
  int width, rows, stride, apex_x, apex_y;
  float* limits;
  float* ways;
  std::int32_t *shifts, *pending, *places;
};

}  // namespace
}  // namespace surf
#endif

HWY_BEFORE_NAMESPACE();
namespace surf {
namespace {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::CappedTag<float, 16> floats;
constexpr hn::RebindToSigned<decltype(floats)> ints;
constexpr int lanes = static_cast<int>(hn::MaxLanes(floats));
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Finds the samples that can touch the point: those with scan + tip - here >= -tolerance. Keeps
/// vectors that hold one, as tip - here, and -infinity for the other samples. Returns the number of
/// vectors. The scan meets the tip's rows downwards.
HWY_INLINE int find_ways(const CarverWork& w) {
  const auto here = hn::Set(floats, w.here), lowest = hn::Set(floats, -w.tolerance);
  const float* const first = w.scan + w.apex_y * w.scan_stride + w.apex_x - (w.width - 1);
  int count = 0;
  for (int j = 0; j < w.rows; ++j)
    for (int i = 0; i < w.stride; i += lanes) {
      const auto shift = static_cast<std::int32_t>(i - j * w.scan_stride);
      const auto way = hn::Sub(hn::LoadU(floats, w.mirrored + j * w.stride + i), here);
      const auto touches = hn::Ge(hn::Add(hn::LoadU(floats, first + shift), way), lowest);
      if (hn::AllFalse(floats, touches)) continue;
      hn::StoreU(hn::IfThenElse(touches, way, hn::Set(floats, -infinity)), floats,
                 w.ways + count * lanes);
      w.shifts[count++] = shift;
    }
  return count;
}

struct Way {
  float sum;  ///< the largest of way + z
  float offset;
  std::int32_t shift;
};

/// The way with the largest sum of way and height, for heights that the sample (0, 0) of the
/// mirrored tip meets at z.
HWY_INLINE Way best_way(const CarverWork& w, int count, const float* z) {
  auto most = hn::Set(floats, -infinity);
  auto at = hn::Zero(ints);
  for (int n = 0; n < count; ++n) {
    const auto sum =
        hn::Add(hn::LoadU(floats, z + w.shifts[n]), hn::LoadU(floats, w.ways + n * lanes));
    const auto more = hn::Gt(sum, most);  // not for infinity - infinity
    most = hn::IfThenElse(more, sum, most);
    at = hn::IfThenElse(hn::RebindMask(ints, more), hn::Set(ints, n), at);
  }
  float sums[lanes];
  std::int32_t vectors[lanes];
  hn::StoreU(most, floats, sums);
  hn::StoreU(at, ints, vectors);
  int best = 0;
  for (int l = 1; l < lanes; ++l)
    if (sums[l] > sums[best]) best = l;
  return {sums[best], w.ways[vectors[best] * lanes + best], w.shifts[vectors[best]] + best};
}

/// The scan's heights that the tip's samples meet if the tip touches this way.
HWY_INLINE const float* met(const CarverWork& w, const Way& way) {
  // shift = column - row * stride with the column of the mirrored sample.
  return w.scan - (w.width - 1) + way.shift;
}

/// Lists the samples that the way does not allow the height of their limit.
HWY_INLINE int find_pending(const CarverWork& w, const Way& way) {
  const auto offset = hn::Set(floats, way.offset);
  const float* z = met(w, way);
  int count = 0;
  for (int j = 0; j < w.rows; ++j, z += w.scan_stride)
    for (int i = 0; i < w.stride; i += lanes) {
      const int k = j * w.stride + i;
      const auto allowed = hn::Add(hn::LoadU(floats, z + i), offset);
      const auto lower = hn::Lt(allowed, hn::LoadU(floats, w.limits + k));
      if (hn::AllFalse(floats, lower)) continue;
      const auto mask = hn::RebindMask(ints, lower);
      hn::CompressStore(hn::Iota(ints, static_cast<std::int32_t>(j * w.scan_stride + i)), mask,
                        ints, w.places + count);
      count +=
          static_cast<int>(hn::CompressStore(hn::Iota(ints, k), mask, ints, w.pending + count));
    }
  return count;
}

/// Any way that touches bounds the demand from below, so only the samples matter that the first way
/// does not allow their limit. For each of these the best way decides. It often allows others, too.
void carve(const CarverWork& w) {
  const int ways = find_ways(w);
  if (ways == 0) return;
  const Way first = best_way(w, ways, w.apex + w.apex_y * w.scan_stride + w.apex_x - (w.width - 1));
  int pending = find_pending(w, first);
  while (pending > 0) {
    const std::int32_t k = w.pending[pending - 1];
    const Way best = best_way(w, ways, w.scan - (w.width - 1) + w.places[pending - 1]);
    if (best.sum < w.limits[k]) {
      w.limits[k] = best.sum;
      --pending;
      continue;
    }
    const float* const z = met(w, best);
    int left = 0;
    for (int n = 0; n < pending; ++n)
      if (z[w.places[n]] + best.offset < w.limits[w.pending[n]]) {
        w.places[left] = w.places[n];
        w.pending[left++] = w.pending[n];
      }
    pending = left;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace
}  // namespace surf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf {
namespace {

HWY_EXPORT(carve);

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int lanes = 16;  // of the widest vectors

}  // namespace

CarvedScan::CarvedScan(const Grid<float>& heights, double layer, int tip_width, int tip_height)
    : width_(heights.width()), height_(heights.height()), margin_x_(tip_width + lanes),
      margin_y_(tip_height), stride_(width_ + 2 * margin_x_) {
  top_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 2 * margin_y_),
              infinity);
  bottom_.assign(top_.size(), -infinity);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const float z = heights(x, y);
      if (!std::isfinite(z)) continue;
      top_[offset(x, y)] = z + static_cast<float>(layer);
      bottom_[offset(x, y)] = z - static_cast<float>(layer);
    }
}

void TipCarver::begin(const CarvedTip& tip) {
  const std::size_t count = tip.z.size();
  limits_.resize(count);
  for (std::size_t k = 0; k < count; ++k) limits_[k] = tip.z[k] - tip.threshold[k];
  // Vectors are stored whole.
  ways_.resize(count);
  shifts_.resize(count);
  pending_.resize(count + lanes);
  places_.resize(count + lanes);
}

void TipCarver::carve(const CarvedScan& scan, const std::vector<float>& apex, int x, int y,
                      const CarvedTip& tip) {
  HWY_DYNAMIC_DISPATCH(carve)
  ({tip.mirrored.data(), scan.top(x, y), apex.data() + scan.offset(x, y), scan.stride(),
    scan.bottom(x, y), tip.apex_tolerance, tip.width, tip.height, tip.stride, tip.apex_x,
    tip.apex_y, limits_.data(), ways_.data(), shifts_.data(), pending_.data(), places_.data()});
}

}  // namespace surf
#endif
