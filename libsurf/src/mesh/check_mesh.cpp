// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/check_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "mesh/weld.h"

namespace surf {
namespace {

/// Numbers gathered per point and sorted there: a counting sort followed by many tiny sorts, much
/// quicker than one large sort.
struct Buckets {
  std::vector<std::size_t> begin;      ///< of every point's values; one more at the end
  std::vector<std::uint64_t> values;
};

/// `for_each(put)` calls put(point, value) for everything there is, the same each time.
template <class ForEach>
Buckets gather(std::size_t points, const ForEach& for_each) {
  Buckets buckets;
  std::vector<std::size_t>& begin = buckets.begin;
  begin.assign(points + 1, 0);
  for_each([&](std::uint32_t point, std::uint64_t) { ++begin[point]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  buckets.values.resize(begin.back());
  // begin[p] is p's end here, and becomes its beginning while the bucket is filled.
  for_each([&](std::uint32_t point, std::uint64_t value) {
    buckets.values[--begin[point]] = value;
  });
  const auto first = buckets.values.begin();
  for (std::size_t p = 0; p < points; ++p) {
    std::sort(first + static_cast<std::ptrdiff_t>(begin[p]),
              first + static_cast<std::ptrdiff_t>(begin[p + 1]));
  }
  return buckets;
}

// A triangle with a repeated corner runs forth and back along one edge: it bounds nothing and has
// no part in the counts of edges and duplicates.
bool has_repeated_corner(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

std::vector<Triangle> welded_triangles(const TriangleMesh& mesh, const Weld& weld) {
  std::vector<Triangle> triangles(mesh.triangles.size());
  std::ranges::transform(mesh.triangles, triangles.begin(), weld);
  return triangles;
}

void count_duplicates(const std::vector<Triangle>& triangles, std::size_t points,
                      MeshReport& report) {
  const Buckets buckets = gather(points, [&](const auto& put) {
    for (Triangle t : triangles) {
      if (has_repeated_corner(t)) continue;
      std::ranges::sort(t);
      put(t[0], std::uint64_t{t[1]} << 32 | t[2]);
    }
  });
  for (std::size_t p = 0; p < points; ++p) {
    for (std::size_t i = buckets.begin[p] + 1; i < buckets.begin[p + 1]; ++i) {
      if (buckets.values[i] == buckets.values[i - 1]) ++report.duplicate_triangles;
    }
  }
}

/// One undirected edge: how often it is run through from its lower to its higher point and back.
struct EdgeUse {
  std::uint32_t low;
  std::uint32_t high;
  std::size_t forward;
  std::size_t backward;
};

template <class Visit>
void visit_edges(const std::vector<Triangle>& triangles, std::size_t points, const Visit& visit) {
  const Buckets buckets = gather(points, [&](const auto& put) {
    for (const Triangle& t : triangles) {
      if (has_repeated_corner(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k];
        const std::uint32_t b = t[(k + 1) % 3];
        put(std::min(a, b), std::uint64_t{std::max(a, b)} << 1 | (a > b));
      }
    }
  });
  for (std::uint32_t low = 0; low < points; ++low) {
    const std::size_t end = buckets.begin[low + 1];
    for (std::size_t i = buckets.begin[low]; i < end;) {
      const auto high = static_cast<std::uint32_t>(buckets.values[i] >> 1);
      EdgeUse edge{low, high, 0, 0};
      for (; i < end && buckets.values[i] >> 1 == high; ++i) {
        ++(buckets.values[i] & 1 ? edge.backward : edge.forward);
      }
      visit(edge);
    }
  }
}

void count_edges(const TriangleMesh& mesh, const Weld& weld,
                 const std::vector<Triangle>& triangles, MeshReport& report) {
  bool balanced = true;
  std::size_t edges = 0;
  const auto note = [&](const EdgeUse& edge, std::size_t& count, Vec3& first_nm) {
    if (count++ > 0) return;
    first_nm = (mesh.vertices_nm[weld.first_vertex[edge.low]] +
                mesh.vertices_nm[weld.first_vertex[edge.high]]) * 0.5;
  };
  visit_edges(triangles, weld.points(), [&](const EdgeUse& edge) {
    ++edges;
    balanced &= edge.forward == edge.backward;
    const std::size_t uses = edge.forward + edge.backward;
    if (uses == 1) note(edge, report.boundary_edges, report.first_boundary_nm);
    if (uses > 2) note(edge, report.nonmanifold_edges, report.first_nonmanifold_nm);
    if (uses == 2 && edge.forward != 1) {
      note(edge, report.inconsistent_edges, report.first_inconsistent_nm);
    }
  });
  report.closed_and_oriented = balanced && edges > 0;
}

void measure(const TriangleMesh& mesh, const std::vector<Triangle>& triangles, MeshReport& report) {
  report.bounds_nm = bounds(mesh);
  // Far from the origin the volume would drown in rounding: count from the middle.
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
      ++report.degenerate_triangles;
    }
  }
}

/// Sets of points; the lowest one stands for its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

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

MeshReport check_mesh(const TriangleMesh& mesh) {
  MeshReport report;
  report.triangles = mesh.triangles.size();
  report.bounds_nm = bounds(mesh);
  if (mesh.triangles.empty()) return report;
  validate(mesh);

  const Weld weld = weld_equal_vertices(mesh);
  const std::vector<Triangle> triangles = welded_triangles(mesh, weld);
  report.vertices = weld.points();
  measure(mesh, triangles, report);
  count_edges(mesh, weld, triangles, report);
  count_duplicates(triangles, weld.points(), report);
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

std::string summary(const MeshReport& report) {
  std::string text;
  const auto add = [&text](const std::string& part) {
    if (!text.empty()) text += ", ";
    text += part;
  };
  if (report.closed_and_oriented) {
    add(report.signed_volume_nm3 < 0 ? "closed, normals inward" : "closed");
  }
  if (report.boundary_edges > 0) {
    add(fmt::format("open: {} {}", plural(report.boundary_edges, "boundary edge"),
                    at(report.first_boundary_nm)));
  }
  if (report.inconsistent_edges > 0) {
    add(fmt::format("triangles turned against each other at {} {}",
                    plural(report.inconsistent_edges, "edge"), at(report.first_inconsistent_nm)));
  }
  if (report.nonmanifold_edges > 0) {
    add(fmt::format("more than two triangles at {} {}", plural(report.nonmanifold_edges, "edge"),
                    at(report.first_nonmanifold_nm)));
  }
  if (report.degenerate_triangles > 0) {
    add(plural(report.degenerate_triangles, "degenerate triangle"));
  }
  if (report.duplicate_triangles > 0) add(plural(report.duplicate_triangles, "duplicate triangle"));
  add(plural(report.triangles, "triangle"));
  add(fmt::format("{} {}", report.vertices, report.vertices == 1 ? "vertex" : "vertices"));
  add(plural(report.components, "component"));
  return text;
}

}  // namespace surf
