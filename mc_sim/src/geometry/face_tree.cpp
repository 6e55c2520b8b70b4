// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/face_tree.h"

#include <algorithm>
#include <array>
#include <limits>

#include "geometry/triangle_shape.h"
#include "surf/core/parallel.h"

namespace surf::mc {

namespace {

constexpr std::size_t leaf_size = 4;
constexpr double rounding = 1e-9;  // of squares of distances

float outward(double v, bool up) {
  const auto f = static_cast<float>(v);
  constexpr float far = std::numeric_limits<float>::infinity();
  return std::nextafter(f, up ? far : -far);
}

}  // namespace

FaceTree::FaceTree(const MeshView& mesh, const Box& region, int threads, const Watch& watch) : mesh_(mesh) {
  origin_ = region.center_nm();
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Vec3 &a = mesh.vertices_nm[t[0]], &b = mesh.vertices_nm[t[1]], &c = mesh.vertices_nm[t[2]];
    const auto apart = [&](double Vec3::*x) {
      return std::max({a.*x, b.*x, c.*x}) < region.lower_nm.*x ||
             std::min({a.*x, b.*x, c.*x}) > region.upper_nm.*x;
    };
    if (!apart(&Vec3::x) && !apart(&Vec3::y) && !apart(&Vec3::z)) faces_.push_back(i);
  }
  if (!faces_.empty()) build(threads, watch);
}

void FaceTree::corners(std::uint32_t triangle, const Vec3& about, Vec3 (&out)[3]) const {
  const Triangle& t = mesh_.triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) out[i] = mesh_.vertices_nm[t[i]] - about;
}

void FaceTree::build(int threads, const Watch& watch) {
  struct Item {
    std::array<float, 3> middle;
    std::uint32_t triangle;
  };
  const std::size_t n = faces_.size();
  while ((n >> levels_) > leaf_size) ++levels_;
  std::vector<Item> items(n);
  parallel_for((n + 65535) / 65536, threads, [&](std::size_t block, int) {
    for (std::size_t i = block * 65536; i < std::min(n, (block + 1) * 65536); ++i) {
      Vec3 v[3];
      corners(faces_[i], origin_, v);
      const Vec3 sum = v[0] + v[1] + v[2];
      items[i] = {{static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)},
                  faces_[i]};
    }
  }, watch);
  nodes_.resize((std::size_t{2} << levels_) - 1);
  const auto split = [&](std::size_t node, int level) {
    const Range all = range(node, level), half = range(2 * node + 1, level + 1);
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
  // The top one level at a time, then whole branches.
  const int top = std::min(levels_, 8);
  for (int level = 0; level < top; ++level)
    parallel_for(std::size_t{1} << level, threads, [&](std::size_t k, int) {
      split((std::size_t{1} << level) - 1 + k, level);
    }, watch);
  parallel_for(std::size_t{1} << top, threads, [&](std::size_t k, int) {
    for (int level = top; level <= levels_; ++level) {
      const std::size_t wide = std::size_t{1} << (level - top);
      const std::size_t first = (std::size_t{1} << level) - 1 + k * wide;
      if (level < levels_) {
        for (std::size_t node = first; node < first + wide; ++node) split(node, level);
        continue;
      }
      for (std::size_t node = first; node < first + wide; ++node) {
        const Range r = range(node, level);
        for (std::size_t i = r.first; i < r.last; ++i) faces_[i] = items[i].triangle;
      }
    }
    for (int level = levels_; level >= top; --level) {
      const std::size_t wide = std::size_t{1} << (level - top);
      const std::size_t first = (std::size_t{1} << level) - 1 + k * wide;
      for (std::size_t node = first; node < first + wide; ++node) bound(node, level);
    }
  }, watch);
  for (std::size_t node = (std::size_t{1} << top) - 1; node-- > 0;) bound(node, -1);
}

// The box of a leaf from its triangles, of any other node from its children.
void FaceTree::bound(std::size_t node, int level) {
  Node& box = nodes_[node];
  if (level != levels_) {
    const Node &a = nodes_[2 * node + 1], &b = nodes_[2 * node + 2];
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = std::min(a.lower[k], b.lower[k]);
      box.upper[k] = std::max(a.upper[k], b.upper[k]);
    }
    return;
  }
  Box sum;
  const Range r = range(node, level);
  for (std::size_t i = r.first; i < r.last; ++i) {
    Vec3 v[3];
    corners(faces_[i], origin_, v);
    for (const Vec3& corner : v) sum.extend(corner);
  }
  const double lower[] = {sum.lower_nm.x, sum.lower_nm.y, sum.lower_nm.z};
  const double upper[] = {sum.upper_nm.x, sum.upper_nm.y, sum.upper_nm.z};
  for (int k = 0; k < 3; ++k) {
    box.lower[k] = outward(lower[k], false);
    box.upper[k] = outward(upper[k], true);
  }
}

// A node on its way, with the square of its box's distance from the centre asked for.
struct FaceTree::Entry {
  double squared;
  std::size_t node;
  int level;
};

// Visits the triangles of the leaves that are nearer than the root of `reach_squared()`, which may
// shrink on the way; near ones first.
template <class Reach, class Visit>
void FaceTree::walk(const Vec3& center, const Reach& reach_squared, const Visit& visit) const {
  if (faces_.empty()) return;
  const Vec3 c = center - origin_;
  std::array<Entry, 80> stack;
  std::size_t size = 0;
  const auto found = [&](std::size_t node, int level, Entry& e) {
    const Node& b = nodes_[node];
    const Vec3 lower = Vec3{b.lower[0], b.lower[1], b.lower[2]} - c;
    const Vec3 upper = Vec3{b.upper[0], b.upper[1], b.upper[2]} - c;
    const double x = std::max(std::max(0.0, lower.x), -upper.x);
    const double y = std::max(std::max(0.0, lower.y), -upper.y);
    const double z = std::max(std::max(0.0, lower.z), -upper.z);
    e = {(x * x + y * y + z * z) * (1 - rounding), node, level};
    return e.squared < reach_squared();
  };
  size += found(0, 0, stack[0]) ? 1 : 0;
  while (size > 0) {
    const Entry e = stack[--size];
    if (!(e.squared < reach_squared())) continue;
    if (e.level == levels_) {
      const Range r = range(e.node, e.level);
      for (std::size_t i = r.first; i < r.last; ++i) visit(faces_[i]);
      continue;
    }
    const std::size_t before = size;
    size += found(2 * e.node + 1, e.level + 1, stack[size]) ? 1 : 0;
    size += found(2 * e.node + 2, e.level + 1, stack[size]) ? 1 : 0;
    if (size == before + 2 && stack[size - 2].squared < stack[size - 1].squared)
      std::swap(stack[size - 2], stack[size - 1]);
  }
}

void FaceTree::improve(const Vec3& p, std::uint32_t triangle, Nearest& best) const {
  Vec3 v[3], point;
  corners(triangle, p, v);
  const double distance = distance_of_triangle(v, TriangleShape(v), point);
  if (distance < best.distance) best = {distance, triangle, p + point};
}

void FaceTree::improve(const Vec3& p, Nearest& best) const {
  walk(p, [&] { return best.distance * best.distance; },
       [&](std::uint32_t triangle) { improve(p, triangle, best); });
}

void FaceTree::within(const Vec3& p, double radius, std::vector<std::uint32_t>& out) const {
  const double squared = radius * radius * (1 + rounding);
  walk(p, [&] { return squared; }, [&](std::uint32_t triangle) { out.push_back(triangle); });
}

}  // namespace surf::mc
