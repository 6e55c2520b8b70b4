// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "mesh/weld.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Numbers grouped by point and sorted within each group: a counting sort followed by many tiny
/// sorts, which is much faster than one large sort.
struct Buckets {
  std::vector<std::size_t> begin;  ///< start of every point's values, and the end of the last
  std::vector<std::uint64_t> values;
};

/// `for_each(put)` calls put(point, value) for every value, and gives the same values on each call.
template <class ForEach>
Buckets gather(std::size_t points, const ForEach& for_each) {
  Buckets buckets;
  std::vector<std::size_t>& begin = buckets.begin;
  begin.assign(points + 1, 0);
  for_each([&](std::uint32_t point, std::uint64_t) { ++begin[point]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  buckets.values.resize(begin.back());
  // begin[p] is first the end of p's values; filling the group moves it to their start.
  for_each(
      [&](std::uint32_t point, std::uint64_t value) { buckets.values[--begin[point]] = value; });
  const auto first = buckets.values.begin();
  for (std::size_t p = 0; p < points; ++p) {
    std::sort(first + static_cast<std::ptrdiff_t>(begin[p]),
              first + static_cast<std::ptrdiff_t>(begin[p + 1]));
  }
  return buckets;
}

// A triangle with a repeated corner runs back and forth along one edge: it bounds nothing and has
// no edges.
inline bool has_repeated_corner(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

inline std::vector<Triangle> welded_triangles(const TriangleMesh& mesh, const Weld& weld) {
  std::vector<Triangle> triangles(mesh.triangles.size());
  std::ranges::transform(mesh.triangles, triangles.begin(), weld);
  return triangles;
}

/// Side 3 * triangle + k runs from corner k of a triangle to its next corner.
using Side = std::uint32_t;
inline Side next_side(Side s) { return s % 3 == 2 ? s - 2 : s + 1; }
inline std::uint32_t side_begin(const std::vector<Triangle>& t, Side s) { return t[s / 3][s % 3]; }
inline std::uint32_t side_end(const std::vector<Triangle>& t, Side s) {
  return side_begin(t, next_side(s));
}

/// An undirected edge and the sides that run along it.
struct EdgeUse {
  std::uint32_t low;
  std::uint32_t high;
  std::span<const std::uint64_t> values;

  std::size_t uses() const { return values.size(); }
  Side side(std::size_t i) const { return static_cast<Side>(values[i]); }
};

/// The number of sides that run from the lower to the higher point.
inline std::size_t count_forward(const std::vector<Triangle>& triangles, const EdgeUse& edge) {
  std::size_t forward = 0;
  for (std::size_t i = 0; i < edge.uses(); ++i) {
    forward += side_begin(triangles, edge.side(i)) == edge.low;
  }
  return forward;
}

/// Calls visit(EdgeUse) for every edge, ordered by its points; sides come in rising order.
/// Triangles hold points (see Weld). There are fewer than 2^32 sides; `validate` ensures that.
template <class Visit>
void visit_edges(const std::vector<Triangle>& triangles, std::size_t points, const Visit& visit) {
  const Buckets buckets = gather(points, [&](const auto& put) {
    Side side = 0;
    for (const Triangle& t : triangles) {
      for (std::size_t k = 0; k < 3; ++k, ++side) {
        if (has_repeated_corner(t)) continue;
        const std::uint32_t a = t[k];
        const std::uint32_t b = t[(k + 1) % 3];
        put(std::min(a, b), std::uint64_t{std::max(a, b)} << 32 | side);
      }
    }
  });
  for (std::uint32_t low = 0; low < points; ++low) {
    const std::size_t end = buckets.begin[low + 1];
    for (std::size_t i = buckets.begin[low]; i < end;) {
      const std::uint64_t high = buckets.values[i] >> 32;
      const std::size_t first = i;
      while (i < end && buckets.values[i] >> 32 == high) ++i;
      visit(EdgeUse{low, static_cast<std::uint32_t>(high),
                    std::span(buckets.values).subspan(first, i - first)});
    }
  }
}

}  // namespace surf
