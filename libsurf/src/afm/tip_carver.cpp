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

/// One point of a scan, and space to work in.
struct CarverWork {
  const float* mirrored;  ///< samples of the tip, each row reversed
  const float* scan;      ///< where the point lies
  const float* apex;      ///< the same place in the heights of the apex
  std::ptrdiff_t scan_stride;
  float here, tolerance;
  int width, rows, stride, apex_x, apex_y;
  float* limits;
  // Lists of vectors of samples: numbers, and where the vector begins.
  float* ways;
  std::int32_t* shifts;  ///< in the scan
  float* open;
  std::int32_t *places, *samples;  ///< in the scan and in the tip
};

}  // namespace surf
#endif

HWY_BEFORE_NAMESPACE();
namespace surf::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::CappedTag<float, 16> floats;
constexpr hn::RebindToSigned<decltype(floats)> ints;
constexpr int lanes = static_cast<int>(hn::MaxLanes(floats));
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Finds the samples that can touch the point: those with scan + tip - here >= -tolerance. Lists
/// vectors that hold one, as tip - here, and -infinity for the other samples. Returns the number of
/// vectors. The scan meets the tip's rows downwards.
HWY_INLINE int find_ways(const CarverWork& w) {
  const auto here = hn::Set(floats, w.here), lowest = hn::Set(floats, -w.tolerance),
             none = hn::Set(floats, -infinity);
  const float* const first = w.scan + w.apex_y * w.scan_stride + w.apex_x - (w.width - 1);
  const float* tip = w.mirrored;
  // Copies of the pointers, because numbers that are written might change the originals.
  float* const ways = w.ways;
  std::int32_t* const shifts = w.shifts;
  const int rows = w.rows, stride = w.stride, down = static_cast<int>(w.scan_stride);
  int count = 0;
  for (int j = 0; j < rows; ++j, tip += stride)
    for (int i = 0; i < stride; i += lanes) {
      const std::int32_t shift = i - j * down;
      const auto way = hn::Sub(hn::Load(floats, tip + i), here);
      const auto touches = hn::Ge(hn::Add(hn::LoadU(floats, first + shift), way), lowest);
      if (hn::AllFalse(floats, touches)) continue;
      hn::Store(hn::IfThenElse(touches, way, none), floats, ways + count * lanes);
      shifts[count++] = shift;
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
    const auto way = hn::Load(floats, w.ways + n * lanes);
    const auto sum = hn::Add(hn::LoadU(floats, z + w.shifts[n]), way);
    const auto more = hn::Gt(sum, most);  // not for infinity - infinity
    most = hn::IfThenElse(more, sum, most);
    at = hn::IfThenElse(hn::RebindMask(ints, more), hn::Set(ints, n), at);
  }
  const float sum = hn::GetLane(hn::MaxOfLanes(floats, most));
  const auto l = hn::FindFirstTrue(floats, hn::Eq(most, hn::Set(floats, sum)));
  std::int32_t vectors[lanes];
  hn::StoreU(at, ints, vectors);
  const int lane = static_cast<int>(l);
  return {sum, w.ways[vectors[lane] * lanes + lane], w.shifts[vectors[lane]] + lane};
}

/// The scan's heights that the tip's samples meet if the tip touches this way.
HWY_INLINE const float* met(const CarverWork& w, const Way& way) {
  return w.scan - (w.width - 1) + way.shift;
}

/// Lists vectors of samples of which the way does not allow all their limits: these limits, and
/// -infinity for the other samples. Returns the number of vectors.
HWY_INLINE int find_open(const CarverWork& w, const Way& way) {
  const auto offset = hn::Set(floats, way.offset), none = hn::Set(floats, -infinity);
  const float* const z = met(w, way);
  const int rows = w.rows, stride = w.stride, up = static_cast<int>(w.scan_stride);
  const float* const limits = w.limits;
  float* const open = w.open;
  std::int32_t *const places = w.places, *const samples = w.samples;
  int count = 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < stride; i += lanes) {
      const std::int32_t place = j * up + i, sample = j * stride + i;
      const auto limit = hn::Load(floats, limits + sample);
      const auto lower = hn::Lt(hn::Add(hn::LoadU(floats, z + place), offset), limit);
      if (hn::AllFalse(floats, lower)) continue;
      hn::Store(hn::IfThenElse(lower, limit, none), floats, open + count * lanes);
      places[count] = place;
      samples[count++] = sample;
    }
  return count;
}

/// Leaves out of this list what the way allows.
HWY_INLINE int still_open(const CarverWork& w, int count, const Way& way) {
  const auto offset = hn::Set(floats, way.offset), none = hn::Set(floats, -infinity);
  const float* const z = met(w, way);
  float* const open = w.open;
  std::int32_t *const places = w.places, *const samples = w.samples;
  int left = 0;
  for (int n = 0; n < count; ++n) {
    const std::int32_t place = places[n], sample = samples[n];
    const auto limit = hn::Load(floats, open + n * lanes);
    const auto lower = hn::Lt(hn::Add(hn::LoadU(floats, z + place), offset), limit);
    // Written even if it does not count, because a branch here is hard to predict.
    hn::Store(hn::IfThenElse(lower, limit, none), floats, open + left * lanes);
    places[left] = place;
    samples[left] = sample;
    left += !hn::AllFalse(floats, lower);
  }
  return left;
}

/// Each way bounds from below what the point allows, so all samples but those are done that the
/// first way does not allow their limit. The way that allows such a sample the most decides about
/// it, and mostly allows others their limit, too.
void carve(const CarverWork& w) {
  const int ways = find_ways(w);
  if (ways == 0) return;
  int open =
      find_open(w, best_way(w, ways, w.apex + w.apex_y * w.scan_stride + w.apex_x - (w.width - 1)));
  while (open > 0) {
    float* const last = w.open + (open - 1) * lanes;
    int l = 0;
    while (l < lanes && !(last[l] > -infinity)) ++l;
    if (l == lanes) {
      --open;
      continue;
    }
    const Way best = best_way(w, ways, w.scan - (w.width - 1) + w.places[open - 1] + l);
    if (best.sum < last[l]) {
      w.limits[w.samples[open - 1] + l] = best.sum;
      last[l] = -infinity;
    } else {
      open = still_open(w, open, best);
    }
  }
}

}  // namespace surf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf {
namespace {

HWY_EXPORT(carve);

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int lanes = 16;  // of the widest vectors

}  // namespace

CarvedScan::CarvedScan(const Grid<float>& heights, double layer, int tip_width, int tip_height)
    : width_(heights.width()), height_(heights.height()), margin_x_(tip_width + 2 * lanes),
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
  ways_.resize(count);
  open_.resize(count);
  for (auto* list : {&shifts_, &places_, &samples_}) list->resize(count);
}

void TipCarver::carve(const CarvedScan& scan, const std::vector<float>& apex, int x, int y,
                      const CarvedTip& tip) {
  HWY_DYNAMIC_DISPATCH(carve)
  ({tip.mirrored.data(), scan.top(x, y), apex.data() + scan.offset(x, y), scan.stride(),
    scan.bottom(x, y), tip.apex_tolerance, tip.width, tip.height, tip.stride, tip.apex_x,
    tip.apex_y, limits_.data(), ways_.data(), shifts_.data(), open_.data(), places_.data(),
    samples_.data()});
}

}  // namespace surf
#endif
