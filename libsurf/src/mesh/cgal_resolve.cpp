// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled with CGAL's checks on. If a check fails it throws, and the attempt is given up.
#include "mesh/cgal_resolve.h"

// Without this macro CGAL first tries to smooth intersections away, which does not terminate on
// some meshes (many_small_holes.ply of the test data with its large hole filled).
#define CGAL_PMP_REMOVE_SELF_INTERSECTIONS_NO_SMOOTHING

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <exception>
#include <numeric>
#include <tuple>

#include "mesh/edges.h"
#include "surf/core/error.h"

namespace surf {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// CGAL reports its steps; those that can take long check the cancel token.
struct Corefining : pmp::Corefinement::Default_visitor<Mesh> {
  explicit Corefining(const Watch& w) : watch(&w) {}
  const Watch* watch;
  void progress_filtering_intersections(double) const { watch->check(); }
  void edge_face_intersections_step() const { watch->check(); }
  void intersection_of_coplanar_faces_step() const { watch->check(); }
  void triangulating_faces_step() const { watch->check(); }
  void build_output_step() const { watch->check(); }
};

struct Mending : pmp::experimental::Remove_self_intersection_default_visitor<Mesh> {
  const Watch* watch;
  void start_iteration() const { watch->check(); }
  void start_component_handling() const { watch->check(); }
};

/// Converts to CGAL's mesh. A point that several fans share becomes several vertices. Returns false
/// if the mesh cannot be made manifold.
bool to_cgal(const TriangleMesh& mesh, Mesh& out) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3& v : mesh.vertices_nm) points.emplace_back(v.x, v.y, v.z);
  std::vector<std::vector<std::size_t>> polygons;
  for (const Triangle& t : mesh.triangles) {
    if (has_repeated_corner(t)) return false;
    polygons.push_back({t[0], t[1], t[2]});
  }
  pmp::orient_polygon_soup(points, polygons);
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) return false;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, out);
  return true;
}

// The order of CGAL's results depends on memory addresses. Vertices are sorted by their coordinates
// and triangles by their corners, so that results are the same on every run.
void put_in_order(TriangleMesh& mesh) {
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 &p = mesh.vertices_nm[a], &q = mesh.vertices_nm[b];
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  };
  std::vector<std::uint32_t> order(mesh.vertices_nm.size()), rank(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), less);
  std::vector<Vec3> vertices;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = i;
    vertices.push_back(mesh.vertices_nm[order[i]]);
  }
  mesh.vertices_nm = std::move(vertices);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& corner : t) corner = rank[corner];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  std::sort(mesh.triangles.begin(), mesh.triangles.end());
}

TriangleMesh from_cgal(const Mesh& mesh) {
  TriangleMesh out;
  std::vector<std::uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
  for (const auto v : mesh.vertices()) {
    number[v.idx()] = static_cast<std::uint32_t>(out.vertices_nm.size());
    const auto& p = mesh.point(v);
    out.vertices_nm.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) {
      if (k == 3) return {};
      t[k++] = number[v.idx()];
    }
    out.triangles.push_back(t);
  }
  put_in_order(out);
  return out;
}

}  // namespace

TriangleMesh unite(const std::vector<TriangleMesh>& bodies, const Watch& watch) {
  try {
    Mesh sum;
    for (const TriangleMesh& body : bodies) {
      watch.check();
      Mesh next;
      if (!to_cgal(body, next)) return {};
      if (sum.is_empty()) {
        sum = next;
        continue;
      }
      Mesh united;
      if (!pmp::corefine_and_compute_union(
              sum, next, united,
              pmp::parameters::throw_on_self_intersection(true).visitor(Corefining(watch)))) {
        return {};
      }
      sum = united;
    }
    return from_cgal(sum);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception&) {
    return {};
  }
}

TriangleMesh mend_self_intersections(const TriangleMesh& mesh, const Watch& watch) {
  try {
    Mesh mended;
    if (!to_cgal(mesh, mended)) return {};
    pmp::experimental::remove_self_intersections(
        mended, CGAL::parameters::preserve_genus(false).visitor(Mending{{}, &watch}));
    return from_cgal(mended);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace surf
