// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/triangle_tree.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr std::size_t leaf_size = 4;
constexpr std::size_t block_size = 65536;  // triangles per unit of work
// Share of the diagonal; a point this close lies on the surface.
constexpr double negligible = 1e-12;

double squared(const Vec3& v) { return dot(v, v); }

float outward(double v, bool up) {
  const auto f = static_cast<float>(v);
  constexpr float far = std::numeric_limits<float>::infinity();
  return std::nextafter(f, up ? far : -far);
}

}  // namespace

TriangleTree::TriangleTree(const MeshView& mesh, const Watch& watch, int threads)
    : mesh_(mesh), faces_(mesh.triangles.size()) {
  std::iota(faces_.begin(), faces_.end(), 0u);
  const Box box = bounds(mesh);
  if (!box.empty()) origin_ = box.center_nm();
  if (!faces_.empty()) build(watch, threads);
}

TriangleTree::TriangleTree(const MeshView& mesh, const Box& region, const Watch& watch, int threads)
    : mesh_(mesh), origin_(region.center_nm()) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (overlap(box_of(i), region)) faces_.push_back(i);
  if (!faces_.empty()) build(watch, threads);
}

void TriangleTree::build(const Watch& watched, int threads) {
  const Watch watch{{}, watched.cancel};  // building is short compared to the use of the tree
  struct Item {
    std::array<float, 3> middle;
    std::uint32_t triangle;
  };
  const std::size_t n = faces_.size();
  while ((n >> levels_) > leaf_size) ++levels_;
  std::vector<Item> items(n);
  parallel_for(
      (n + block_size - 1) / block_size, threads,
      [&](std::size_t block, int) {
        for (std::size_t i = block * block_size; i < std::min(n, (block + 1) * block_size); ++i) {
          const Corners t = corners(faces_[i]);
          const Vec3 sum = (t.a - origin_) + (t.b - origin_) + (t.c - origin_);
          items[i] = {
              {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)},
              faces_[i]};
        }
      },
      watch);
  nodes_.resize((std::size_t{2} << levels_) - 1);
  const auto split = [&](std::size_t node, int level) {
    const Range all = range({node, level}), half = range({2 * node + 1, level + 1});
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (std::size_t i = all.first; i < all.last; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], items[i].middle[k]);
        high[k] = std::max(high[k], items[i].middle[k]);
      }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(all.first), at(half.last), at(all.last), [&](const Item& a, const Item& b) {
      return a.middle[axis] < b.middle[axis] ||
             (a.middle[axis] == b.middle[axis] && a.triangle < b.triangle);
    });
  };
  // Builds the top levels one by one, then whole branches in parallel.
  const int top = std::min(levels_, 8);
  for (int level = 0; level < top; ++level)
    parallel_for(
        std::size_t{1} << level, threads,
        [&](std::size_t k, int) { split((std::size_t{1} << level) - 1 + k, level); }, watch);
  parallel_for(
      std::size_t{1} << top, threads,
      [&](std::size_t k, int) {
        for (int level = top; level <= levels_; ++level) {
          const std::size_t wide = std::size_t{1} << (level - top);
          const std::size_t first = (std::size_t{1} << level) - 1 + k * wide;
          if (level < levels_) {
            for (std::size_t node = first; node < first + wide; ++node) split(node, level);
            continue;
          }
          for (std::size_t node = first; node < first + wide; ++node) {
            const Range r = range({node, level});
            for (std::size_t i = r.first; i < r.last; ++i) faces_[i] = items[i].triangle;
          }
        }
        for (int level = levels_; level >= top; --level) {
          const std::size_t wide = std::size_t{1} << (level - top);
          const std::size_t first = (std::size_t{1} << level) - 1 + k * wide;
          for (std::size_t node = first; node < first + wide; ++node) bound({node, level});
        }
      },
      watch);
  for (std::size_t node = (std::size_t{1} << top) - 1; node-- > 0;) bound({node, -1});
  Vec3 diagonal;
  for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const std::size_t k = axis == &Vec3::x ? 0 : axis == &Vec3::y ? 1 : 2;
    diagonal.*axis =
        static_cast<double>(nodes_[0].upper[k]) - static_cast<double>(nodes_[0].lower[k]);
  }
  negligible_squared_ = negligible * negligible * squared(diagonal);
}

// Sets the box of a leaf from its triangles, that of any other node from its children.
void TriangleTree::bound(const Place& place) {
  Node& box = nodes_[place.node];
  if (place.level != levels_) {
    const Node &a = nodes_[2 * place.node + 1], &b = nodes_[2 * place.node + 2];
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = std::min(a.lower[k], b.lower[k]);
      box.upper[k] = std::max(a.upper[k], b.upper[k]);
    }
    return;
  }
  Box sum;
  const Range r = range(place);
  for (std::size_t i = r.first; i < r.last; ++i) {
    const Corners t = corners(faces_[i]);
    for (const Vec3& corner : {t.a, t.b, t.c}) sum.extend(corner - origin_);
  }
  const double lower[] = {sum.lower_nm.x, sum.lower_nm.y, sum.lower_nm.z};
  const double upper[] = {sum.upper_nm.x, sum.upper_nm.y, sum.upper_nm.z};
  for (int k = 0; k < 3; ++k) {
    box.lower[k] = outward(lower[k], false);
    box.upper[k] = outward(upper[k], true);
  }
}

TriangleTree::Closest TriangleTree::closest(const Vec3& p, std::uint32_t start) const {
  std::uint32_t best = start;
  double least = squared(closest_point(corners(start), p) - p);
  const auto reach = [&] { return least > negligible_squared_ ? least : 0.0; };
  visit_near(p, reach, [&](std::uint32_t triangle) {
    const double d = squared(closest_point(corners(triangle), p) - p);
    if (d >= least) return;
    least = d;
    best = triangle;
  });
  return {std::sqrt(least), best};
}

}  // namespace surf
