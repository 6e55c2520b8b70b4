// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/check_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "mesh/disjoint_sets.h"
#include "mesh/edges.h"
#include "mesh/weld.h"

namespace surf {
namespace {

/// Counts an event and stores the place of the first one.
void note(std::size_t& count, Vec3& first_nm, const Vec3& place_nm) {
  if (count++ == 0) first_nm = place_nm;
}

void count_duplicates(const TriangleMesh& mesh, const Weld& weld,
                      const std::vector<Triangle>& triangles, MeshReport& report) {
  const Buckets buckets = gather(weld.points(), [&](const auto& put) {
    for (Triangle t : triangles) {
      if (has_repeated_corner(t)) continue;
      std::ranges::sort(t);
      put(t[0], std::uint64_t{t[1]} << 32 | t[2]);
    }
  });
  const auto place = [&](std::uint64_t point) {
    return mesh.vertices_nm[weld.first_vertex[point]];
  };
  for (std::size_t p = 0; p < weld.points(); ++p) {
    for (std::size_t i = buckets.begin[p] + 1; i < buckets.begin[p + 1]; ++i) {
      const std::uint64_t others = buckets.values[i];
      if (others != buckets.values[i - 1]) continue;
      note(report.duplicate_triangles, report.first_duplicate_nm,
           (place(p) + place(others >> 32) + place(others & 0xffffffffu)) * (1.0 / 3));
    }
  }
}

/// Fans of triangles around points: sets of corners that are connected by edges at their point.
class Fans {
 public:
  explicit Fans(std::size_t corners) : sets_(corners) {}

  void join(const std::vector<Triangle>& triangles, const EdgeUse& edge) {
    const Side s0 = edge.side(0);
    const bool from_low = side_begin(triangles, s0) == edge.low;
    const Side low = from_low ? s0 : next_side(s0);
    const Side high = from_low ? next_side(s0) : s0;
    for (std::size_t i = 1; i < edge.uses(); ++i) {
      const Side s = edge.side(i);
      const bool forward = side_begin(triangles, s) == edge.low;
      sets_.unite(low, forward ? s : next_side(s));
      sets_.unite(high, forward ? next_side(s) : s);
    }
  }

  /// Calls visit(point) for every point with more than one fan.
  template <class Visit>
  void visit_broken(const std::vector<Triangle>& triangles, std::size_t points,
                    const Visit& visit) {
    std::vector<unsigned char> fans(points, 0);
    for (Side corner = 0; corner < 3 * triangles.size(); ++corner) {
      if (sets_.find(corner) != corner || has_repeated_corner(triangles[corner / 3])) continue;
      unsigned char& count = fans[side_begin(triangles, corner)];
      if (count < 2 && ++count == 2) visit(side_begin(triangles, corner));
    }
  }

 private:
  DisjointSets sets_;
};

constexpr std::size_t edges_between_looks = std::size_t{1} << 16;

void count_edges(const TriangleMesh& mesh, const Weld& weld, const std::vector<Triangle>& triangles,
                 const Watch& watch, MeshReport& report) {
  bool balanced = true;
  std::size_t edges = 0;
  Fans fans(3 * triangles.size());
  const auto place = [&](std::uint32_t point) {
    return mesh.vertices_nm[weld.first_vertex[point]];
  };
  visit_edges(triangles, weld.points(), [&](const EdgeUse& edge) {
    if (++edges % edges_between_looks == 0) watch.check();
    fans.join(triangles, edge);
    const std::size_t forward = count_forward(triangles, edge);
    const std::size_t backward = edge.uses() - forward;
    balanced &= forward == backward;
    report.doubled_directed_edges += (forward > 1) + (backward > 1);
    if (edge.uses() == 2 && forward == 1) return;
    const Vec3 middle = (place(edge.low) + place(edge.high)) * 0.5;
    if (edge.uses() == 1) note(report.boundary_edges, report.first_boundary_nm, middle);
    if (edge.uses() == 2) note(report.inconsistent_edges, report.first_inconsistent_nm, middle);
    if (edge.uses() > 2) note(report.nonmanifold_edges, report.first_nonmanifold_nm, middle);
  });
  fans.visit_broken(triangles, weld.points(), [&](std::uint32_t point) {
    note(report.nonmanifold_vertices, report.first_nonmanifold_vertex_nm, place(point));
  });
  report.closed_and_oriented = balanced && edges > 0;
}

void measure(const TriangleMesh& mesh, const std::vector<Triangle>& triangles, MeshReport& report) {
  report.bounds_nm = bounds(mesh);
  // The volume is computed relative to the centre, because rounding would spoil it far from the
  // origin.
  const Vec3 middle = report.bounds_nm.center_nm();
  constexpr double tolerance = 4 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Vec3 a = mesh.vertices_nm[t[0]] - middle;
    const Vec3 ab = mesh.vertices_nm[t[1]] - mesh.vertices_nm[t[0]];
    const Vec3 ac = mesh.vertices_nm[t[2]] - mesh.vertices_nm[t[0]];
    const Vec3 normal = cross(ab, ac);
    const double twice_area = length(normal);
    report.area_nm2 += 0.5 * twice_area;
    report.signed_volume_nm3 += dot(a, normal) / 6;
    if (has_repeated_corner(triangles[i]) || twice_area <= tolerance * length(ab) * length(ac)) {
      note(report.degenerate_triangles, report.first_degenerate_nm,
           mesh.vertices_nm[t[0]] + (ab + ac) * (1.0 / 3));
    }
  }
}

DisjointSets connect(const std::vector<Triangle>& triangles, std::size_t points) {
  DisjointSets sets(points);
  for (const Triangle& t : triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  return sets;
}

std::string plural(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string at(const Vec3& p) {
  return fmt::format("near ({:.6g}, {:.6g}, {:.6g}) nm", p.x, p.y, p.z);
}

}  // namespace

MeshReport check_mesh(const TriangleMesh& mesh, const Watch& watch) {
  MeshReport report;
  report.triangles = mesh.triangles.size();
  report.bounds_nm = bounds(mesh);
  if (mesh.triangles.empty()) return report;
  validate(mesh);
  watch.check();

  const Weld weld = weld_equal_vertices(mesh);
  watch.report(0.2, 1);
  const std::vector<Triangle> triangles = welded_triangles(mesh, weld);
  report.vertices = weld.points();
  measure(mesh, triangles, report);
  watch.report(0.3, 1);
  count_edges(mesh, weld, triangles, watch, report);
  watch.report(0.8, 1);
  count_duplicates(mesh, weld, triangles, report);
  watch.report(0.9, 1);
  DisjointSets sets = connect(triangles, weld.points());
  for (std::uint32_t p = 0; p < weld.points(); ++p) report.components += sets.find(p) == p;
  return report;
}

std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  validate(mesh);
  const Weld weld = weld_equal_vertices(mesh);
  const std::vector<Triangle> triangles = welded_triangles(mesh, weld);
  DisjointSets sets = connect(triangles, weld.points());

  std::vector<std::uint32_t> number(weld.points(), Weld::unused);
  std::vector<std::uint32_t> components;
  components.reserve(triangles.size());
  std::uint32_t next = 0;
  for (const Triangle& t : triangles) {
    std::uint32_t& n = number[sets.find(t[0])];
    if (n == Weld::unused) n = next++;
    components.push_back(n);
  }
  return components;
}

std::vector<std::string> faults(const MeshReport& r) {
  std::vector<std::string> lines;
  const auto add = [&](std::size_t count, const char* what, const std::string& counted,
                       const Vec3& place) {
    if (count > 0) lines.push_back(fmt::format("{}{} {}", what, counted, at(place)));
  };
  add(r.boundary_edges, "open: ", plural(r.boundary_edges, "boundary edge"), r.first_boundary_nm);
  add(r.inconsistent_edges, "triangles turned against each other at ",
      plural(r.inconsistent_edges, "edge"), r.first_inconsistent_nm);
  add(r.nonmanifold_edges, "more than two triangles at ", plural(r.nonmanifold_edges, "edge"),
      r.first_nonmanifold_nm);
  add(r.nonmanifold_vertices, "parts that touch in a point at ",
      r.nonmanifold_vertices == 1 ? "1 vertex" : fmt::format("{} vertices", r.nonmanifold_vertices),
      r.first_nonmanifold_vertex_nm);
  add(r.degenerate_triangles, "", plural(r.degenerate_triangles, "degenerate triangle"),
      r.first_degenerate_nm);
  add(r.duplicate_triangles, "", plural(r.duplicate_triangles, "duplicate triangle"),
      r.first_duplicate_nm);
  return lines;
}

std::string summary(const MeshReport& report) {
  std::vector<std::string> parts = faults(report);
  if (report.closed_and_oriented) {
    parts.insert(parts.begin(), report.signed_volume_nm3 < 0 ? "closed, normals inward" : "closed");
  }
  parts.push_back(plural(report.triangles, "triangle"));
  parts.push_back(
      fmt::format("{} {}", report.vertices, report.vertices == 1 ? "vertex" : "vertices"));
  parts.push_back(plural(report.components, "component"));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace surf
