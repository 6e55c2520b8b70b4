// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/lattice_delaunay.h"

#include <cstdlib>

#include "mesh/edges.h"

namespace surf {
namespace {

__extension__ using Wide = __int128;  // a fourth-order determinant needs more than 64 bits

/// Whether `p` lies strictly inside the circle through a, b, c, which run counter-clockwise.
bool in_circle(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint p) {
  const auto x = [&](LatticePoint q) { return std::int64_t{q.x} - p.x; };
  const auto y = [&](LatticePoint q) { return std::int64_t{q.y} - p.y; };
  const auto squared = [&](LatticePoint q) { return x(q) * x(q) + y(q) * y(q); };
  const auto minor = [&](LatticePoint q, LatticePoint r) {
    return Wide(x(q) * y(r) - x(r) * y(q));
  };
  return squared(a) * minor(b, c) + squared(b) * minor(c, a) + squared(c) * minor(a, b) > 0;
}

std::uint32_t previous_side(std::uint32_t side) { return next_side(next_side(side)); }

}  // namespace

LatticeDelaunay::LatticeDelaunay(std::int32_t columns, std::int32_t rows)
    : points_{{0, 0}, {columns - 1, 0}, {columns - 1, rows - 1}, {0, rows - 1}} {
  add();
  add();
  set(0, {0, 1, 2}, none, none, 3);
  set(1, {0, 2, 3}, 2, none, none);
}

std::uint32_t LatticeDelaunay::add() {
  triangles_.push_back({});
  opposite_.insert(opposite_.end(), 3, none);
  return static_cast<std::uint32_t>(triangles_.size() - 1);
}

// Sets the corners of a triangle, and the sides opposite to the sides that begin at them.
void LatticeDelaunay::set(std::uint32_t triangle, Triangle corners, std::uint32_t first,
                          std::uint32_t second, std::uint32_t third) {
  triangles_[triangle] = corners;
  std::uint32_t side = 3 * triangle;
  for (const std::uint32_t other : {first, second, third}) {
    opposite_[side] = other;
    if (other != none) opposite_[other] = side;
    ++side;
  }
}

std::uint32_t LatticeDelaunay::find(LatticePoint p, std::uint32_t start) const {
  std::uint32_t t = start;
  for (std::size_t k = 0; k < 3;) {
    if (doubled_area(corner(t, k), corner(t, (k + 1) % 3), p) >= 0) {
      ++k;
      continue;
    }
    // The region is convex, so `p` is never beyond the rim.
    t = opposite_[3 * t + k] / 3;
    k = 0;
  }
  return t;
}

bool LatticeDelaunay::breaks_delaunay(std::uint32_t side) const {
  const std::uint32_t other = opposite_[side];
  if (other == none) return false;
  const Triangle& t = triangles_[side / 3];
  return in_circle(points_[t[0]], points_[t[1]], points_[t[2]],
                   points_[triangles_[other / 3][previous_side(other) % 3]]);
}

// Before the flip, the side runs from r to l; the third corner of its triangle is a, that of the
// other triangle is b. After it, the side's triangle is (a, b, l) and the other (b, a, r).
void LatticeDelaunay::flip(std::uint32_t side) {
  const std::uint32_t other = opposite_[side];
  const std::uint32_t s = side / 3, o = other / 3;
  const std::uint32_t r = triangles_[s][side % 3], l = triangles_[o][other % 3];
  const std::uint32_t a = triangles_[s][previous_side(side) % 3];
  const std::uint32_t b = triangles_[o][previous_side(other) % 3];
  const std::uint32_t la = opposite_[next_side(side)], ar = opposite_[previous_side(side)];
  const std::uint32_t rb = opposite_[next_side(other)], bl = opposite_[previous_side(other)];
  set(s, {a, b, l}, none, bl, la);
  set(o, {b, a, r}, 3 * s, ar, rb);
}

// Every suspect is the side opposite to the new point in its triangle, so flips do not move other
// suspects.
void LatticeDelaunay::restore(std::vector<std::uint32_t>& suspects,
                              std::vector<std::uint32_t>& changed) {
  while (!suspects.empty()) {
    const std::uint32_t side = suspects.back();
    suspects.pop_back();
    if (!breaks_delaunay(side)) continue;
    const std::uint32_t s = side / 3, o = opposite_[side] / 3;
    flip(side);
    changed.push_back(s);
    changed.push_back(o);
    suspects.push_back(3 * s + 1);  // b to l and r to b, opposite to a
    suspects.push_back(3 * o + 2);
  }
}

void LatticeDelaunay::insert(LatticePoint p, std::uint32_t triangle,
                             std::vector<std::uint32_t>& changed) {
  const auto n = static_cast<std::uint32_t>(points_.size());
  std::uint32_t on = none;  // the side that the point is on
  for (std::uint32_t k = 0; k < 3; ++k)
    if (doubled_area(corner(triangle, k), corner(triangle, (k + 1) % 3), p) == 0)
      on = 3 * triangle + k;
  points_.push_back(p);
  std::vector<std::uint32_t> suspects;
  if (on == none) {
    const auto [a, b, c] = triangles_[triangle];
    const std::uint32_t ab = opposite_[3 * triangle], bc = opposite_[3 * triangle + 1],
                        ca = opposite_[3 * triangle + 2];
    const std::uint32_t u = add(), v = add();
    set(triangle, {a, b, n}, ab, none, none);
    set(u, {b, c, n}, bc, none, 3 * triangle + 1);
    set(v, {c, a, n}, ca, 3 * triangle + 2, 3 * u + 1);
    suspects = {3 * triangle, 3 * u, 3 * v};
  } else {
    // The side runs from r to l, and the third corner of its triangle is a. The triangle is split
    // into (a, r, n) and (l, a, n).
    const std::uint32_t other = opposite_[on];
    const std::uint32_t r = triangles_[triangle][on % 3],
                        l = triangles_[triangle][next_side(on) % 3],
                        a = triangles_[triangle][previous_side(on) % 3];
    const std::uint32_t la = opposite_[next_side(on)], ar = opposite_[previous_side(on)];
    const std::uint32_t u = add();
    set(triangle, {a, r, n}, ar, none, none);
    set(u, {l, a, n}, la, 3 * triangle + 2, none);
    suspects = {3 * triangle, 3 * u};
    if (other != none) {
      const std::uint32_t o = other / 3, b = triangles_[o][previous_side(other) % 3];
      const std::uint32_t rb = opposite_[next_side(other)], bl = opposite_[previous_side(other)];
      const std::uint32_t v = add();
      set(o, {r, b, n}, rb, none, 3 * triangle + 1);
      set(v, {b, l, n}, bl, 3 * u + 2, 3 * o + 1);
      suspects.push_back(3 * o);
      suspects.push_back(3 * v);
    }
  }
  for (const std::uint32_t side : suspects) changed.push_back(side / 3);
  restore(suspects, changed);
}

void LatticeDelaunay::prefer_rising_diagonals() {
  for (std::uint32_t side = 0; side < opposite_.size(); ++side) {
    const std::uint32_t other = opposite_[side];
    if (other == none || other < side) continue;
    const LatticePoint p = corner(side / 3, side % 3), q = corner(other / 3, other % 3);
    const std::int32_t dx = q.x - p.x, dy = q.y - p.y;
    if (std::abs(dx) != 1 || dx != -dy) continue;
    const LatticePoint a = corner(side / 3, previous_side(side) % 3),
                       b = corner(other / 3, previous_side(other) % 3);
    const LatticePoint c{p.x, q.y}, d{q.x, p.y};
    if ((a == c && b == d) || (a == d && b == c)) flip(side);
  }
}

}  // namespace surf
