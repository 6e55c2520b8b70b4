// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/original_section.h"

#include <cmath>

#include "surf/core/triangle_geometry.h"

namespace surf {
namespace {

constexpr int most_steps = 4096;

}  // namespace

OriginalSection::OriginalSection(const TriangleMesh& mesh, const Watch& watch)
    : mesh_(mesh), twin_(3 * mesh.triangles.size(), none), begin_(mesh.vertices_nm.size() + 1, 0),
      corners_(3 * mesh.triangles.size()) {
  visit_edges(mesh.triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
    if (edge.uses() != 2 || count_forward(mesh.triangles, edge) != 1) return;
    twin_[edge.side(0)] = edge.side(1);
    twin_[edge.side(1)] = edge.side(0);
  });
  watch.check();
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++begin_[v];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  for (Side corner = 0; corner < corners_.size(); ++corner)
    corners_[--begin_[side_begin(mesh.triangles, corner)]] = corner;
}

Side OriginalSection::first_side(std::uint32_t from, std::uint32_t to, const Vec3& up,
                                 const Vec3& left) const {
  const auto& v = mesh_.vertices_nm;
  Side best = none;
  double most = 0;
  const Vec3 ahead = v[to] - v[from];
  for (std::size_t i = begin_[from]; i < begin_[from + 1]; ++i) {
    const Side across = next_side(corners_[i]);
    const Vec3 a = v[side_begin(mesh_.triangles, across)] - v[from];
    const Vec3 b = v[side_end(mesh_.triangles, across)] - v[from];
    const double la = dot(left, a), lb = dot(left, b);
    // The triangle lies to both sides of the line, and the line leaves through it.
    if (!(la <= 0 && lb >= 0 && lb > la && dot(a * lb - b * la, ahead) > 0)) continue;
    // Several may, where bodies touch or the surface folds.
    const Vec3 normal = cross(a, b);
    const double facing = dot(normal, up),
                 signed_square = facing * std::abs(facing) / dot(normal, normal);
    if (best == none || signed_square > most) best = across, most = signed_square;
  }
  return best;
}

bool OriginalSection::stays_near(std::uint32_t from, std::uint32_t to, const Vec3& up,
                                 double squared_nm) const {
  const auto& v = mesh_.vertices_nm;
  const auto& triangles = mesh_.triangles;
  const Vec3 left = cross(up, v[to] - v[from]);
  Side across = first_side(from, to, up, left);
  for (int step = 0; across != none && step < most_steps; ++step) {
    const std::uint32_t right_end = side_begin(triangles, across);
    const std::uint32_t left_end = side_end(triangles, across);
    if (right_end == to || left_end == to) return true;
    const double la = dot(left, v[right_end] - v[from]), lb = dot(left, v[left_end] - v[from]);
    const double share = lb > la ? la / (la - lb) : 0.5;
    const Vec3 crossing = v[right_end] + (v[left_end] - v[right_end]) * share;
    const Vec3 off = crossing - closest_point_of_line(v[from], v[to], crossing);
    if (!(dot(off, off) <= squared_nm)) return false;
    const Side beyond = twin_[across];
    if (beyond == none) return false;
    const Side one = next_side(beyond), other = next_side(one);
    const std::uint32_t tip = side_begin(triangles, other);
    if (tip == to) return true;
    // `beyond` runs from the left end to the right end: `one` from the right end to the tip.
    across = dot(left, v[tip] - v[from]) >= 0 ? one : other;
  }
  return false;
}

}  // namespace surf
