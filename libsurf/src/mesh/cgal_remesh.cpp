// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cgal_remesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

namespace surf {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

TriangleMesh plain(const Mesh& mesh) {
  TriangleMesh out;
  std::vector<std::uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
  for (const Mesh::Vertex_index v : mesh.vertices()) {
    number[v] = static_cast<std::uint32_t>(out.vertices_nm.size());
    const Kernel::Point_3& p = mesh.point(v);
    out.vertices_nm.push_back({p.x(), p.y(), p.z()});
  }
  for (const Mesh::Face_index f : mesh.faces()) {
    Triangle t{};
    std::size_t corner = 0;
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
      t[corner++] = number[v];
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace

TriangleMesh remesh_chosen(const TriangleMesh& mesh, const std::vector<bool>& chosen,
                           const RemeshOptions& options) {
  Mesh work;
  for (const Vec3& v : mesh.vertices_nm) work.add_vertex(Kernel::Point_3(v.x, v.y, v.z));
  std::vector<Mesh::Face_index> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const Mesh::Face_index f =
        work.add_face(Mesh::Vertex_index(c[0]), Mesh::Vertex_index(c[1]), Mesh::Vertex_index(c[2]));
    if (f == Mesh::null_face()) return {};
    if (chosen[t]) faces.push_back(f);
  }
  auto sharp = work.add_property_map<Mesh::Edge_index, bool>("e:sharp", false).first;
  pmp::detect_sharp_edges(work, options.sharp_deg, sharp);
  for (const Mesh::Edge_index e : work.edges())
    if (work.is_border(e)) sharp[e] = true;
  options.watch.check();
  pmp::isotropic_remeshing(
      faces, options.edge_nm, work,
      CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.rounds))
          .edge_is_constrained_map(sharp)
          .protect_constraints(false));
  return plain(work);
}

}  // namespace surf
