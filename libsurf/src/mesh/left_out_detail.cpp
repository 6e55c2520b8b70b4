// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/left_out_detail.h"

#include <algorithm>
#include <limits>

#include "surf/mesh/vertex_normals.h"

namespace surf {
namespace {

// New faces look roughly where the original did at their corners, or some would fold over others.
constexpr double least_cosine = 0.2;
// A vertex with a triangle below the first has no outside, as where bodies touch: any will do.
constexpr double no_side = 1e-3, any = -2;

/// For every vertex, less than what its own triangles have: the sides of a thin fin turn away from
/// the normals along its crest.
std::vector<double> least_cosines(const TriangleMesh& mesh, const std::vector<Vec3>& normals) {
  std::vector<double> least(normals.size(), least_cosine);
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices_nm[t[0]];
    const Vec3 normal = cross(mesh.vertices_nm[t[1]] - a, mesh.vertices_nm[t[2]] - a);
    const double size = length(normal);
    for (const std::uint32_t v : t) {
      const double cosine = size > 0 ? dot(normal, normals[v]) / size : 0;
      least[v] = std::min(least[v], cosine > no_side ? cosine / 2 : any);
    }
  }
  return least;
}

}  // namespace

LeftOutDetail::LeftOutDetail(const TriangleMesh& mesh, std::size_t faces, double tolerance_nm,
                             const Watch& watch)
    : mesh_(mesh), section_(mesh, watch), normals_(vertex_normals(mesh)),
      least_cosine_(least_cosines(mesh, normals_)), squared_nm_(tolerance_nm * tolerance_nm),
      first_(faces, none), count_(faces, 0), next_(mesh.vertices_nm.size(), none) {}

bool LeftOutDetail::faces_out(const Merger::NewFace& face) const {
  const double size = length(face.normal);
  return std::ranges::all_of(face.vertices, [&](std::uint32_t v) {
    return dot(face.normal, normals_[v]) >= least_cosine_[v] * size;
  });
}

bool LeftOutDetail::settle(const Merger& merger, std::uint32_t vertex) {
  const Vec3 p = mesh_.vertices_nm[vertex];
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t best = none;
  for (const Merger::NewFace& f : merger.new_faces) {
    const Vec3 off = closest_point(f.corners, p) - p;
    const double d = dot(off, off);
    if (d < least) least = d, best = f.face;
  }
  homes_.push_back({vertex, best});
  return least <= squared_nm_;
}

bool LeftOutDetail::allows(const Merger& merger) {
  for (const Merger::NewFace& face : merger.new_faces)
    if (!faces_out(face)) return false;
  homes_.clear();
  if (!settle(merger, merger.vertex)) return false;
  for (std::size_t i = 0; i < merger.rim.size(); ++i) {
    const Vec3 up = merger.new_faces[i].normal + merger.new_faces[i + 1].normal;
    if (!section_.stays_near(merger.target, merger.rim[i], up, squared_nm_)) return false;
  }
  for (const std::uint32_t face : merger.old_faces)
    for (std::uint32_t v = first_[face]; v != none; v = next_[v])
      if (!settle(merger, v)) return false;
  return true;
}

void LeftOutDetail::perform(const Merger& merger) {
  for (const std::uint32_t face : merger.old_faces) first_[face] = none, count_[face] = 0;
  for (const Home& h : homes_) add(h.face, h.vertex);
  for (const Merger::NewFace& f : merger.new_faces)
    if (count_[f.face] > most_points) thin(f.face);
}

void LeftOutDetail::add(std::uint32_t face, std::uint32_t vertex) {
  next_[vertex] = first_[face];
  first_[face] = vertex;
  ++count_[face];
}

/// Forgets every other vertex. Long lists are of flat places, or of detail far below the tolerance.
void LeftOutDetail::thin(std::uint32_t face) {
  std::uint32_t kept = 0;
  for (std::uint32_t v = first_[face]; v != none; v = next_[v], ++kept)
    if (next_[v] != none) next_[v] = next_[next_[v]];
  count_[face] = kept;
}

}  // namespace surf
