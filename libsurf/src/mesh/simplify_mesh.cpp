// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/simplify_mesh.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "core/argument.h"
#include "mesh/disjoint_sets.h"
#include "mesh/edges.h"
#include "surf/core/error.h"

namespace surf {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
// Index of the vertex in the merged mesh.
using PointNumber = OpenMesh::VPropHandleT<std::uint32_t>;
using Decimater = OpenMesh::Decimater::DecimaterT<HalfedgeMesh>;

constexpr unsigned max_valence = 64;  // beyond it OpenMesh's cost grows with its square
constexpr std::size_t step_down = 4;  // factor between runs
constexpr Side sides_between_looks = 3 * 16384;
// Bisections of the last step; the result is within a few per cent of the fewest triangles.
constexpr int bisections = 5;

bool before(const Vec3& a, const Vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Converts a merged mesh to a halfedge mesh, cut where more than two triangles meet or
/// orientations disagree. Vertices along cuts are locked so that the cuts fit together again. Also
/// locked are vertices at rims, vertices with many triangles, and the places of `fixed`, which is
/// sorted. Coordinates are relative to `middle`, because OpenMesh's plane equations lose precision
/// far from the origin.
HalfedgeMesh to_halfedges(const TriangleMesh& mesh, const Vec3& middle, PointNumber& number,
                          const std::vector<Vec3>& fixed, const Watch& watch) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  DisjointSets fans(3 * triangles.size());
  visit_edges(triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
    if (edge.uses() != 2 || count_forward(triangles, edge) != 1) return;
    const Side a = edge.side(0), b = edge.side(1);
    fans.unite(a, next_side(b));
    fans.unite(next_side(a), b);
  });
  watch.check();
  HalfedgeMesh out;
  out.add_property(number);
  out.request_face_normals();
  out.request_vertex_status();
  out.request_edge_status();
  out.request_face_status();
  out.reserve(mesh.vertices_nm.size(), 3 * triangles.size() / 2, triangles.size());
  std::vector<HalfedgeMesh::VertexHandle> of_fan(3 * triangles.size()),
      of_point(mesh.vertices_nm.size());
  for (Side corner = 0; corner < 3 * triangles.size(); ++corner) {
    const std::uint32_t fan = fans.find(corner);
    if (of_fan[fan].is_valid()) continue;
    const std::uint32_t point = side_begin(triangles, corner);
    const Vec3 p = mesh.vertices_nm[point] - middle;
    of_fan[fan] = out.add_vertex({p.x, p.y, p.z});
    out.property(number, of_fan[fan]) = point;
    if (of_point[point].is_valid()) {
      out.status(of_point[point]).set_locked(true);
      out.status(of_fan[fan]).set_locked(true);
    }
    of_point[point] = of_fan[fan];
  }
  for (Side side = 0; side < 3 * triangles.size(); side += 3) {
    if (side % sides_between_looks == 0) watch.check();
    if (has_repeated_corner(triangles[side / 3])) continue;
    out.add_face(of_fan[fans.find(side)], of_fan[fans.find(side + 1)], of_fan[fans.find(side + 2)]);
  }
  for (const auto v : out.vertices()) {
    const bool stays =
        std::ranges::binary_search(fixed, mesh.vertices_nm[out.property(number, v)], before);
    if (stays || out.is_boundary(v) || out.valence(v) > max_valence) out.status(v).set_locked(true);
  }
  out.update_face_normals();
  return out;
}

/// The remaining triangles, over the vertices of the merged mesh.
TriangleMesh from_halfedges(const HalfedgeMesh& mesh, const PointNumber& number,
                            const TriangleMesh& original) {
  TriangleMesh out{original.vertices_nm, {}};
  for (const auto f : mesh.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const auto v : mesh.fv_range(f)) t[k++] = mesh.property(number, v);
    out.triangles.push_back(t);
  }
  return out;
}

/// A decimation module that allows every collapse. It checks for cancellation before collapses and
/// reports progress after them.
template <class MeshT>  // the macro needs this form
class Looking : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(Looking, MeshT, Looking);

  explicit Looking(MeshT& mesh) : Base(mesh, true) {}

  void watch(const Watch& watch, double vertices_to_go) {
    watch_ = &watch;
    to_go_ = vertices_to_go;
  }

  float collapse_priority(const CollapseInfo&) override {
    if (++asked_ % between_looks == 0) watch_->check();
    return Base::LEGAL_COLLAPSE;
  }

  void postprocess_collapse(const CollapseInfo&) override {
    if (++gone_ % between_looks == 0) watch_->report(std::min(double(gone_), to_go_), to_go_);
  }

 private:
  static constexpr std::size_t between_looks = 2048;  // about a millisecond
  const Watch* watch_ = nullptr;
  double to_go_ = 1;
  std::size_t asked_ = 0, gone_ = 0;
};

/// Decimates to a number of triangles, or as near to it as possible without turning faces over.
TriangleMesh decimated(const TriangleMesh& mesh, std::size_t triangles,
                       const std::vector<Vec3>& fixed, const Watch& watch) {
  const Vec3 middle = bounds(mesh).center_nm();
  PointNumber number;
  watch.check();
  HalfedgeMesh work = to_halfedges(mesh, middle, number, fixed, watch);
  Decimater decimater(work);
  OpenMesh::Decimater::ModQuadricT<HalfedgeMesh>::Handle quadric;
  OpenMesh::Decimater::ModNormalFlippingT<HalfedgeMesh>::Handle flipping;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.add(flipping);
  decimater.module(flipping).set_max_normal_deviation(90);
  Looking<HalfedgeMesh>::Handle looking;
  decimater.add(looking);
  const double faces_to_go =
      static_cast<double>(mesh.triangles.size()) - static_cast<double>(triangles);
  decimater.module(looking).watch(
      watch, std::max(1.0, 0.5 * faces_to_go));  // a collapse removes two faces
  watch.check();
  if (!decimater.initialize()) {
    throw std::logic_error("simplify_mesh: the decimater refuses its modules");
  }
  decimater.decimate_to_faces(0, triangles);
  watch.check();
  work.garbage_collection();
  return merge_equal_vertices(from_halfedges(work, number, mesh));
}

/// Reduces a mesh step by step as long as the measured deviation from the original allows it.
class Descent {
 public:
  Descent(const TriangleMesh& original, const SimplifyOptions& options, SimplifySummary& summary)
      : original_(original), options_(options), summary_(summary), best_(original),
        fixed_(options.fixed_nm) {
    std::ranges::sort(fixed_, before);
  }

  TriangleMesh run() {
    const std::size_t least = std::max<std::size_t>(options_.triangles, 4);
    while (best_.triangles.size() > least) {
      const std::size_t from = best_.triangles.size();
      const std::size_t aim =
          options_.tolerance_nm > 0 ? std::max(least, from / step_down) : options_.triangles;
      if (attempt(aim)) {
        if (best_.triangles.size() + 4 > from || best_.triangles.size() > aim + aim / 4) break;
        continue;
      }
      bisect(aim, from);
      break;
    }
    return std::move(best_);
  }

 private:
  bool attempt(std::size_t triangles) {
    // The number of attempts is not known, so each gets half of the remaining progress.
    const double from = 1 - std::pow(0.5, tries_), to = 1 - std::pow(0.5, ++tries_);
    const Watch watch = options_.watch.part(from, to);
    TriangleMesh next = decimated(best_, triangles, fixed_, watch.part(0, 0.7));
    if (next.triangles.empty() || next.triangles.size() >= best_.triangles.size()) return false;
    ++summary_.attempts;
    const MeshDeviation d =
        mesh_deviation(original_, next, {.threads = options_.threads, .watch = watch.part(0.7, 1)});
    if (options_.tolerance_nm > 0 && !(d.largest_nm() <= options_.tolerance_nm)) return false;
    best_ = std::move(next);
    summary_.deviation = d;
    return true;
  }

  void bisect(std::size_t too_few, std::size_t enough) {
    for (int i = 0; i < bisections && enough > too_few + 2; ++i) {
      const std::size_t middle = too_few + (enough - too_few) / 2;
      if (attempt(middle)) enough = best_.triangles.size();
      else too_few = middle;
    }
  }

  const TriangleMesh& original_;
  const SimplifyOptions& options_;
  SimplifySummary& summary_;
  TriangleMesh best_;
  std::vector<Vec3> fixed_;  // sorted
  int tries_ = 0;
};

}  // namespace

SimplifiedMesh simplify_mesh(const TriangleMesh& mesh, const SimplifyOptions& options) {
  require_not_negative(options.tolerance_nm, "tolerance");
  if (options.tolerance_nm == 0 && options.triangles == 0) {
    throw UsageError("simplify", "neither a tolerance nor a number of triangles is given",
                     "Give one of them, or both");
  }
  validate(mesh);
  SimplifySummary summary;
  summary.triangles_before = mesh.triangles.size();
  options.watch.check();
  const TriangleMesh original = merge_equal_vertices(mesh);
  TriangleMesh result = Descent(original, options, summary).run();
  summary.triangles_after = result.triangles.size();
  summary.reached = options.triangles == 0 || result.triangles.size() <= options.triangles;
  return {std::move(result), summary};
}

}  // namespace surf
