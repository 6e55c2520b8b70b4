// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_carver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "afm/tip_carver.cpp"
#include "core/each_target.h"

// Loops over rows of 16 floats, the number that the widest vectors hold.
HWY_BEFORE_NAMESPACE();
namespace surf::HWY_NAMESPACE {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int lanes = 16;  // of the widest vectors

float largest(const float* of_lanes) { return *std::max_element(of_lanes, of_lanes + lanes); }

// allowed = max(allowed, scan + offset).
void allow(float* __restrict allowed, const float* __restrict scan, float offset, int rows,
           int stride, std::ptrdiff_t scan_stride) {
  for (int j = 0; j < rows; ++j, allowed += stride, scan += scan_stride)
    for (int i = 0; i < stride; ++i) {
      const float v = scan[i] + offset;
      allowed[i] = v > allowed[i] ? v : allowed[i];
    }
}

// The largest of tip - threshold - allowed.
float excess(const float* __restrict tip, const float* __restrict threshold,
             const float* __restrict allowed, int count) {
  float most[lanes];
  for (float& m : most) m = -infinity;
  for (int k = 0; k < count; k += lanes)
    for (int l = 0; l < lanes; ++l) {
      const float v = tip[k + l] - threshold[k + l] - allowed[k + l];
      most[l] = v > most[l] ? v : most[l];  // ignores NaN
    }
  return largest(most);
}

// The position of the largest tip - threshold - allowed.
int place_of_excess(const float* __restrict tip, const float* __restrict threshold,
                    const float* __restrict allowed, float value) {
  for (int k = 0;; k += lanes) {
    int equal = 0;
    for (int l = 0; l < lanes; ++l)
      equal += tip[k + l] - threshold[k + l] - allowed[k + l] == value;
    if (equal == 0) continue;
    while (!(tip[k] - threshold[k] - allowed[k] == value)) ++k;
    return k;
  }
}

// ways = tip - here if scan + tip - here >= -tolerance, else -infinity. Rows of the scan are read
// downwards.
void find(float* __restrict ways, const float* __restrict tip, const float* __restrict scan,
          float here, float tolerance, int rows, int stride, std::ptrdiff_t scan_stride) {
  for (int j = 0; j < rows; ++j, ways += stride, tip += stride, scan -= scan_stride)
    for (int i = 0; i < stride; ++i) {
      const float offset = tip[i] - here;
      ways[i] = scan[i] + offset >= -tolerance ? offset : -infinity;
    }
}

int number_of(const float* ways, int count) {
  int number = 0;
  for (int k = 0; k < count; ++k) number += ways[k] > -infinity;
  return number;
}

// The largest of ways + scan.
float best_of(const float* __restrict ways, const float* __restrict scan, int rows, int stride,
              std::ptrdiff_t scan_stride) {
  float most[lanes];
  for (float& m : most) m = -infinity;
  for (int j = 0; j < rows; ++j, ways += stride, scan -= scan_stride)
    for (int k = 0; k < stride; k += lanes)
      for (int l = 0; l < lanes; ++l) {
        const float v = scan[k + l] + ways[k + l];
        most[l] = v > most[l] ? v : most[l];  // ignores NaN
      }
  return largest(most);
}

// The position of that maximum.
int place_of_best(const float* __restrict ways, const float* __restrict scan, int stride,
                  std::ptrdiff_t scan_stride, float value) {
  for (int first = 0;; first += stride, scan -= scan_stride)
    for (int i = 0; i < stride; i += lanes) {
      int equal = 0;
      for (int l = 0; l < lanes; ++l) equal += scan[i + l] + ways[first + i + l] == value;
      if (equal == 0) continue;
      while (!(scan[i] + ways[first + i] == value)) ++i;
      return first + i;
    }
}

}  // namespace surf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf {
namespace {

HWY_EXPORT(allow);
HWY_EXPORT(excess);
HWY_EXPORT(place_of_excess);
HWY_EXPORT(find);
HWY_EXPORT(number_of);
HWY_EXPORT(best_of);
HWY_EXPORT(place_of_best);

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

void TipCarver::carve(const CarvedScan& scan, int x, int y, const CarvedTip& tip,
                      std::vector<float>& demand) {
  ways_.resize(tip.z.size());
  HWY_DYNAMIC_DISPATCH(find)
  (ways_.data(), tip.mirrored.data(), scan.top(x + tip.apex_x - (tip.width - 1), y + tip.apex_y),
   scan.bottom(x, y), tip.apex_tolerance, tip.height, tip.stride, scan.stride());
  const int count = tip.height * tip.stride;
  allowed_.assign(static_cast<std::size_t>(count), -infinity);
  const auto try_way = [&](int i, int j, float offset) {  // contact at the tip's sample (i, j)
    HWY_DYNAMIC_DISPATCH(allow)
    (allowed_.data(), scan.top(x - i, y - j), offset, tip.height, tip.stride, scan.stride());
  };
  constexpr int few = 24;
  if (HWY_DYNAMIC_DISPATCH(number_of)(ways_.data(), count) <= few) {
    for (int w = 0; w < count; ++w)
      if (const float offset = ways_[static_cast<std::size_t>(w)]; offset > -infinity)
        try_way(tip.width - 1 - w % tip.stride, w / tip.stride, offset);
    for (std::size_t k = 0; k < tip.z.size(); ++k)
      if (allowed_[k] < tip.z[k] - tip.threshold[k] && allowed_[k] > -infinity)
        demand[k] = std::min(demand[k], allowed_[k] + tip.threshold[k]);
    return;
  }
  // Few of many contacts are needed. Repeatedly take the sample with the largest excess over what
  // the contacts so far allow, and add the contact that allows this sample the most. If that is not
  // enough, no contact is, and the demand on the sample is known.
  for (;;) {
    const float worst =
        HWY_DYNAMIC_DISPATCH(excess)(tip.z.data(), tip.threshold.data(), allowed_.data(), count);
    if (!(worst > 0)) return;
    const int k = HWY_DYNAMIC_DISPATCH(place_of_excess)(tip.z.data(), tip.threshold.data(),
                                                        allowed_.data(), worst);
    const int u = k % tip.stride, v = k / tip.stride;
    const float* around = scan.top(x - (tip.width - 1) + u, y + v);  // at mirrored sample (0, 0)
    const float best =
        HWY_DYNAMIC_DISPATCH(best_of)(ways_.data(), around, tip.height, tip.stride, scan.stride());
    if (best == -infinity) return;  // no contact is possible
    const auto at = static_cast<std::size_t>(k);
    if (best < tip.z[at] - tip.threshold[at]) {
      demand[at] = std::min(demand[at], best + tip.threshold[at]);
      allowed_[at] = infinity;
      continue;
    }
    const int w =
        HWY_DYNAMIC_DISPATCH(place_of_best)(ways_.data(), around, tip.stride, scan.stride(), best);
    if (best == infinity) allowed_[at] = infinity;  // beyond the border everything is allowed
    try_way(tip.width - 1 - w % tip.stride, w / tip.stride, ways_[static_cast<std::size_t>(w)]);
  }
}

}  // namespace surf
#endif
