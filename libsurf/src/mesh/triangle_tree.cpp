// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace surf {
namespace {

constexpr std::uint32_t leaf_size = 4;
constexpr std::uint32_t watched_size = 4096;   // triangles: less is a matter of milliseconds
constexpr double negligible = 1e-12;   // of the diagonal: a point that near lies on the surface

double squared(const Vec3& v) { return dot(v, v); }

double squared_distance(const Box& box, const Vec3& p) {
  const auto outside = [](double low, double high, double x) {
    return std::max({low - x, x - high, 0.0});
  };
  return squared({outside(box.lower_nm.x, box.upper_nm.x, p.x),
                  outside(box.lower_nm.y, box.upper_nm.y, p.y),
                  outside(box.lower_nm.z, box.upper_nm.z, p.z)});
}

double Vec3::*longest_axis(const Box& box) {
  const Vec3 size = box.size_nm();
  if (size.x >= size.y && size.x >= size.z) return &Vec3::x;
  return size.y >= size.z ? &Vec3::y : &Vec3::z;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh, const Watch& watch)
    : mesh_(mesh), triangles_(mesh.triangles.size()) {
  std::iota(triangles_.begin(), triangles_.end(), 0u);
  std::vector<Vec3> middles(triangles_.size());
  for (std::uint32_t t = 0; t < middles.size(); ++t) middles[t] = box_of(t).center_nm();
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(triangles_.size()), middles, watch);
  const double diagonal = length(nodes_[0].box.size_nm());
  negligible_squared_ = negligible * diagonal * negligible * diagonal;
}

void TriangleTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
                         const std::vector<Vec3>& middles, const Watch& watch) {
  if (count > watched_size) watch.check();
  if (count <= leaf_size) {
    for (std::uint32_t i = first; i < first + count; ++i) nodes_[node].box.extend(box_of(triangles_[i]));
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  Box box;
  for (std::uint32_t i = first; i < first + count; ++i) box.extend(middles[triangles_[i]]);
  double Vec3::*const axis = longest_axis(box);
  const auto begin = triangles_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return middles[a].*axis < middles[b].*axis || (middles[a].*axis == middles[b].*axis && a < b);
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(nodes_.size() + 2);
  split(children, first, count / 2, middles, watch);
  split(children + 1, first + count / 2, count - count / 2, middles, watch);
  nodes_[node].box = nodes_[children].box;
  nodes_[node].box.extend(nodes_[children + 1].box);
}

TriangleTree::Closest TriangleTree::closest(const Vec3& p, std::uint32_t start) const {
  std::uint32_t best = start;
  double least = squared(closest_point(corners(start), p) - p);
  struct Entry {
    double squared;
    std::uint32_t node;
  };
  Entry stack[max_depth];
  int size = 0;
  stack[size++] = {squared_distance(nodes_[0].box, p), 0};
  while (size > 0 && least > negligible_squared_) {
    const Entry entry = stack[--size];
    if (entry.squared >= least) continue;
    const Node& node = nodes_[entry.node];
    if (node.count == 0) {
      Entry near{squared_distance(nodes_[node.first].box, p), node.first};
      Entry far{squared_distance(nodes_[node.first + 1].box, p), node.first + 1};
      if (far.squared < near.squared) std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double d = squared(closest_point(corners(triangles_[i]), p) - p);
      if (d < least) {
        least = d;
        best = triangles_[i];
      }
    }
  }
  return {std::sqrt(least), best};
}

}  // namespace surf
