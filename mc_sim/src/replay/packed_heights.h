// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "cascades/cascade_format.h"
#include "geometry/rotation.h"

namespace surf::mc {

/// Heights of many packed points over a plane at once, in whole numbers: to tell which of them need
/// a closer look. Answers err towards a closer look by at most four units of the packed
/// coordinates, which is more than what single precision does to `BranchPose`'s heights. They are
/// the same on every processor.
class PackedHeights {
 public:
  /// `over`: what `BranchPose` has of a plane; `exponent`: of its unit.
  PackedHeights(const Float4& over, int exponent) {
    parts_per_nm_ = power_of_two(-exponent) * one;
    const Float4 parts = over * parts_per_nm_;
    offset_ = whole(parts[3]);
#if defined(__SSE2__)
    const __m128i rounded = _mm_cvtps_epi32(_mm_set_ps(0, parts[2], parts[1], parts[0]));
    weights_ = _mm_cvtsi128_si64(_mm_packs_epi32(rounded, rounded));
#else
    std::int16_t w[4] = {};
    for (std::size_t k = 0; k < 3; ++k) w[k] = static_cast<std::int16_t>(std::lrint(parts[k]));
    std::memcpy(&weights_, w, sizeof w);
#endif
  }

  /// Bit i: point i may be above the plane. `count` points (1 to 16).
  unsigned may_be_above(const std::uint64_t* points, int count) const {
    unsigned bits = 0;
    const std::int32_t least = -margin - offset_;
#if defined(__SSE2__)
    const __m128i limit = _mm_set1_epi32(least);
    for_pairs(points, count, [&](int i, const __m128i& words) {
      bits |= each(_mm_cmpgt_epi32(along(words), limit)) << i;
    });
#else
    for (int i = 0; i < count; ++i) bits |= along(points[i]) > least ? 1u << i : 0u;
#endif
    return bits & ((1u << count) - 1);
  }

  struct Sides {
    unsigned above = 0, below = 0;
  };
  /// Bit i: point i is higher than `by_nm` (>= 0), or lower than its negative.
  Sides sides(const std::uint64_t* points, int count, float by_nm) const {
    const std::int32_t least = whole(by_nm * parts_per_nm_) + margin;
    const std::int32_t high = least - offset_, low = -least - offset_;
    Sides s;
#if defined(__SSE2__)
    const __m128i above = _mm_set1_epi32(high), below = _mm_set1_epi32(low);
    for_pairs(points, count, [&](int i, const __m128i& words) {
      const __m128i heights = along(words);
      s.above |= each(_mm_cmpgt_epi32(heights, above)) << i;
      s.below |= each(_mm_cmpgt_epi32(below, heights)) << i;
    });
#else
    for (int i = 0; i < count; ++i) {
      const std::int32_t height = along(points[i]);
      s.above |= height > high ? 1u << i : 0u;
      s.below |= height < low ? 1u << i : 0u;
    }
#endif
    const unsigned all = (1u << count) - 1;
    return {s.above & all, s.below & all};
  }

  /// Bit i: all of sphere i is farther than `by_nm` (>= 0) from the plane.
  unsigned clear(const std::uint64_t* spheres, int count, float by_nm = 0) const {
    const std::int32_t least = whole(by_nm * parts_per_nm_) + margin;
    unsigned bits = 0;
#if defined(__SSE2__)
    const __m128i offset = _mm_set1_epi32(offset_), beyond = _mm_set1_epi32(least);
    for_pairs(spheres, count, [&](int i, const __m128i& words) {
      const __m128i height = _mm_add_epi32(along(words), offset), sign = _mm_srai_epi32(height, 31);
      const __m128i distance = _mm_sub_epi32(_mm_xor_si128(height, sign), sign);
      const __m128i radius = _mm_slli_epi32(_mm_srli_epi64(words, 48), 14);  // in the lower halves
      const __m128i met = _mm_cmpgt_epi32(distance, _mm_add_epi32(radius, beyond));
      bits |= each(_mm_shuffle_epi32(met, 0xa0)) << i;
    });
#else
    for (int i = 0; i < count; ++i) {
      const std::int32_t height = along(spheres[i]) + offset_;
      const auto radius = static_cast<std::int32_t>(spheres[i] >> 48 << 14);
      bits |= (height < 0 ? -height : height) > radius + least ? 1u << i : 0u;
    }
#endif
    return bits & ((1u << count) - 1);
  }

 private:
  // A weight is a direction's cosine in 2^-14: off by half of one at most, so that three
  // coordinates of 2^15 are off by 3 * 2^14, or three units.
  static constexpr float one = 16384;
  static constexpr std::int32_t margin = 4 * 16384;
  // Farther away the sign of a height does not depend on the point: coordinates come to less than
  // 2^30. So do radii, and sums of two of these stay below 2^31.
  static constexpr float farthest = 1e9f;

  static std::int32_t whole(float parts) {
    return static_cast<std::int32_t>(std::clamp(parts, -farthest, farthest));
  }

#if defined(__SSE2__)
  // The height without offset of two points, each in both halves of its place.
  __m128i along(const __m128i& words) const {
    const __m128i products =
        _mm_madd_epi16(words, _mm_set1_epi64x(weights_));  // of x and y, and of z
    return _mm_add_epi32(products, _mm_shuffle_epi32(products, 0xb1));
  }
  static unsigned each(const __m128i& met) {
    return static_cast<unsigned>(_mm_movemask_pd(_mm_castsi128_pd(met)));
  }

  // Two at a time; nothing beyond them is read.
  template <class Visit>
  static void for_pairs(const std::uint64_t* words, int count, const Visit& visit) {
    int i = 0;
    for (; i + 1 < count; i += 2)
      visit(i, _mm_loadu_si128(reinterpret_cast<const __m128i*>(words + i)));
    if (i < count) visit(i, _mm_loadl_epi64(reinterpret_cast<const __m128i*>(words + i)));
  }
#else
  std::int32_t along(std::uint64_t word) const {
    std::int16_t v[4], w[4];
    std::memcpy(v, &word, sizeof v);
    std::memcpy(w, &weights_, sizeof w);
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
  }
#endif

  std::int64_t weights_ = 0;  // of x, y and z, each of 16 bits, and 0 for what is packed with them
  std::int32_t offset_ = 0;
  float parts_per_nm_ = 0;
};

}  // namespace surf::mc
