// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/one_sided_bound.h"

#include <algorithm>
#include <cmath>

#include "mesh/polygon_cut.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr std::size_t block_size = 512;                              // triangles per unit of work
constexpr double unit = std::numeric_limits<double>::epsilon() / 2;  // of rounding
constexpr std::uint8_t most_cuts = 120;
// Pieces of one triangle: so many, and so many for each triangle of the other surface, which may
// all lie below this one. Needles across needles would take millions.
constexpr std::size_t most_pieces = 20000, most_pieces_each = 64;
constexpr double much_longer =
    3;  // pieces this much longer than what is near them are halved first

double sum_of_sizes(const Vec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

double largest_size(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Weights of b and c for the point of the triangle (0, ab, ac) that is nearest to `ap`. They are
/// those of some point of the triangle even where rounding makes the choice wrong.
std::pair<double, double> weights(const Vec3& ab, const Vec3& ac, const Vec3& ap) {
  const auto share = [](double part, double whole) {
    return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
  };
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const double bb = dot(ab, ab), cc = dot(ac, ac), bc = dot(ab, ac);
  const double d3 = d1 - bb, d4 = d2 - bc;
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {share(d1, d1 - d3), 0};
  const double d5 = d1 - bc, d6 = d2 - cc;
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, share(d2, d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = share(d4 - d3, (d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  const double whole = va + vb + vc, b = share(vb, whole), c = share(vc, whole);
  return {b, std::min(c, 1 - b)};
}

}  // namespace

double distance_at_most(const Corners& t, const Vec3& p) {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const auto [b, c] = weights(ab, ac, ap);
  const Vec3 rest = ap - ab * b - ac * c;
  // Each component is a difference of three products of rounded differences: its error is below
  // 5 units of the sum of their sizes. Weights add up to 1 only within a unit. The rest is reserve.
  const double error = 16 * unit * (sum_of_sizes(ap) + sum_of_sizes(ab) + sum_of_sizes(ac));
  return length(rest) * (1 + 16 * unit) + error + std::numeric_limits<double>::min();
}

namespace {

/// Bounds one triangle after another.
class Bounding {
 public:
  Bounding(const TriangleMesh& from, const TriangleTree& to, const BoundAim& aim)
      : from_(from), to_(to), aim_(aim),
        most_pieces_of_one_(most_pieces + most_pieces_each * to.size()),
        enough_(std::min(aim.enough_nm, aim.limit_nm)) {}

  /// Returns the bound. `failed` is set if the limit could not be proven.
  double of(std::uint32_t triangle, std::uint32_t& near, bool& failed) {
    const Triangle& t = from_.triangles[triangle];
    CutPolygon whole;
    double largest = 0;
    for (const std::uint32_t v : t) {
      whole.add(from_.vertices_nm[v]);
      largest = std::max(largest, largest_size(from_.vertices_nm[v]));
    }
    // A cut rounds a difference, a product and a sum in each of three coordinates.
    of_cut_nm_ = 9 * unit * largest;
    whole.near = near;
    bound_ = 0;
    pieces_ = 0;
    stack_.assign(1, whole);
    failed = false;
    while (!stack_.empty() && !failed) {
      const CutPolygon piece = stack_.back();
      stack_.pop_back();
      failed = !look_at(piece, near);
    }
    return bound_;
  }

 private:
  struct Farthest {
    double distance_nm = 0;
    Vec3 corner;
  };

  Farthest farthest(const CutPolygon& piece, std::uint32_t triangle) const {
    const Corners t = to_.corners(triangle);
    Farthest f;
    for (std::size_t i = 0; i < piece.size; ++i) {
      const double d = distance_at_most(t, piece.corner[i]);
      if (i == 0 || !(d <= f.distance_nm)) f = {d, piece.corner[i]};
    }
    f.distance_nm += piece.cuts * of_cut_nm_;
    return f;
  }

  bool settle(double distance_nm) {
    if (!(distance_nm <= enough_)) return false;
    bound_ = std::max(bound_, distance_nm);
    return true;
  }

  /// Settles a piece, or divides it. Returns false if that shows or leaves the limit exceeded.
  bool look_at(const CutPolygon& piece, std::uint32_t& near) {
    near = to_.closest(piece.middle(), piece.near).triangle;
    const Farthest first = farthest(piece, near);
    if (settle(first.distance_nm)) return true;
    const std::uint32_t other = to_.closest(first.corner, near).triangle;
    const double least =
        distance_at_most(to_.corners(other), first.corner) + piece.cuts * of_cut_nm_;
    if (!(least <= enough_)) {
      if (!(least <= aim_.limit_nm)) {
        near = other;
        if (std::isfinite(aim_.limit_nm) || !std::isfinite(least)) {
          bound_ = std::max(bound_, least);
          return false;
        }
      }
      enough_ = std::min(least * (1 + aim_.accuracy), aim_.limit_nm);
    }
    double distance = first.distance_nm;
    if (other != near) distance = std::min(distance, farthest(piece, other).distance_nm);
    if (settle(distance)) return true;
    if (piece.cuts >= most_cuts || ++pieces_ > most_pieces_of_one_) {
      bound_ = std::max(bound_, distance);
      return distance <= aim_.limit_nm;
    }
    divide(piece, near);
    return true;
  }

  /// Cuts off what lies beside the nearest triangle. Long pieces are halved, so that few cuts pass
  /// through many triangles.
  void divide(CutPolygon piece, std::uint32_t near) {
    piece.near = near;
    const Corners t = to_.corners(near);
    const Vec3 sides[] = {t.b - t.a, t.c - t.b, t.a - t.c}, corners[] = {t.a, t.b, t.c};
    const Vec3 normal = cross(sides[0], sides[1]);
    const auto [from, to] = piece.ends();
    const double long_nm = length(to - from);
    const double near_nm = std::max({length(sides[0]), length(sides[1]), length(sides[2])});
    const double least = std::max(1e-12 * long_nm, 4 * of_cut_nm_);
    bool divided = false;
    if (long_nm <= much_longer * near_nm && piece.cuts < most_cuts / 2) {
      for (int side = 0; side < 3; ++side) {
        const Vec3 inward = cross(normal, sides[side]);
        const double size = length(inward);
        if (!(size > 0)) continue;
        CutPolygon inside, outside;
        if (!cut(piece, corners[side], inward * (1 / size), least, inside, outside)) continue;
        stack_.push_back(outside);
        piece = inside;
        divided = true;
      }
    }
    if (divided) stack_.push_back(piece);
    else halve(piece, from, to, long_nm);
  }

  void halve(const CutPolygon& piece, const Vec3& from, const Vec3& to, double long_nm) {
    CutPolygon one, other;
    if (!(long_nm > 0 && piece.size < CutPolygon::most_corners &&
          cut(piece, (from + to) * 0.5, (to - from) * (1 / long_nm), 0, one, other))) {
      if (piece.size == 3) {  // too small to be cut: no further
        one = piece;
        one.cuts = most_cuts;
        stack_.push_back(one);
        return;
      }
      cut_at_corners(piece, one, other);
    }
    stack_.push_back(one);
    stack_.push_back(other);
  }

  const TriangleMesh& from_;
  const TriangleTree& to_;
  const BoundAim aim_;
  const std::size_t most_pieces_of_one_;
  std::size_t pieces_ = 0;
  // Rises from triangle to triangle.
  double enough_;
  double of_cut_nm_ = 0, bound_ = 0;
  std::vector<CutPolygon> stack_;
};

}  // namespace

double negligible_distance_nm(const TriangleMesh& first, const TriangleMesh& second) {
  Box both = bounds(first);
  const Box other = bounds(second);
  both.extend(other.lower_nm);
  both.extend(other.upper_nm);
  const double distance = 1e-10 * length(both.size_nm());
  return distance > 0 ? distance : std::numeric_limits<double>::min();
}

OneSidedBound bound_one_side(const TriangleMesh& from, const TriangleTree& to, const BoundAim& aim,
                             int threads, const Watch& watch) {
  std::vector<OneSidedBound> blocks((from.triangles.size() + block_size - 1) / block_size);
  parallel_for(
      blocks.size(), threads,
      [&](std::size_t block, int) {
        Bounding bounding(from, to, aim);
        OneSidedBound& out = blocks[block];
        std::uint32_t near = 0;
        const std::size_t end = std::min(from.triangles.size(), (block + 1) * block_size);
        for (std::size_t i = block * block_size; i < end; ++i) {
          bool failed = false;
          const auto triangle = static_cast<std::uint32_t>(i);
          const double bound = bounding.of(triangle, near, failed);
          if (failed) out.unproven.push_back({triangle, near, bound});
          else out.bound_nm = std::max(out.bound_nm, bound);
        }
      },
      watch);
  OneSidedBound all;
  for (const OneSidedBound& block : blocks) {
    all.bound_nm = std::max(all.bound_nm, block.bound_nm);
    all.unproven.insert(all.unproven.end(), block.unproven.begin(), block.unproven.end());
  }
  return all;
}

}  // namespace surf
