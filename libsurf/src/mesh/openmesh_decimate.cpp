// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/openmesh_decimate.h"

// Before the quadrics, whose header needs it.
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <OpenMesh/Core/Geometry/QuadricT.hh>

#include <algorithm>
#include <optional>
#include <queue>
#include <tuple>

#include "mesh/disjoint_sets.h"
#include "mesh/edges.h"
#include "mesh/left_out_detail.h"

namespace surf {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using VertexHandle = HalfedgeMesh::VertexHandle;
using HalfedgeHandle = HalfedgeMesh::HalfedgeHandle;
using Quadric = OpenMesh::Geometry::Quadricd;

constexpr unsigned max_valence = 64;  // beyond it the cost grows with its square
constexpr Side sides_between_looks = 3 * 16384;
constexpr std::size_t attempts_between_looks = 512;  // a few milliseconds
// Of a squared distance, relative to a squared edge: prefers short edges where all is flat, or
// single vertices would collect all of a plane's triangles.
constexpr double length_share = 1e-10;

/// A merged mesh as halfedges, cut where more than two triangles meet or orientations disagree.
/// Vertices along cuts are locked so that the cuts fit together again. Also locked are vertices at
/// rims, vertices with many triangles, and those to be kept. Coordinates are relative to `middle`,
/// because plane equations lose precision far from the origin.
struct Halfedges {
  HalfedgeMesh mesh;
  std::vector<std::uint32_t> point;  ///< of a vertex: its number in the merged mesh
};

Halfedges to_halfedges(const TriangleMesh& mesh, const Vec3& middle,
                       const DecimateOptions& options) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  DisjointSets fans(3 * triangles.size());
  visit_edges(triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
    if (edge.uses() != 2 || count_forward(triangles, edge) != 1) return;
    const Side a = edge.side(0), b = edge.side(1);
    fans.unite(a, next_side(b));
    fans.unite(next_side(a), b);
  });
  options.watch.check();
  Halfedges result;
  HalfedgeMesh& out = result.mesh;
  out.request_vertex_status();
  out.request_edge_status();
  out.request_halfedge_status();
  out.request_face_status();
  out.reserve(mesh.vertices_nm.size(), 3 * triangles.size() / 2, triangles.size());
  std::vector<VertexHandle> of_fan(3 * triangles.size()), of_point(mesh.vertices_nm.size());
  for (Side corner = 0; corner < 3 * triangles.size(); ++corner) {
    const std::uint32_t fan = fans.find(corner);
    if (of_fan[fan].is_valid()) continue;
    const std::uint32_t point = side_begin(triangles, corner);
    const Vec3 p = mesh.vertices_nm[point] - middle;
    of_fan[fan] = out.add_vertex({p.x, p.y, p.z});
    result.point.push_back(point);
    if (of_point[point].is_valid()) {
      out.status(of_point[point]).set_locked(true);
      out.status(of_fan[fan]).set_locked(true);
    }
    of_point[point] = of_fan[fan];
  }
  for (Side side = 0; side < 3 * triangles.size(); side += 3) {
    if (side % sides_between_looks == 0) options.watch.check();
    if (has_repeated_corner(triangles[side / 3])) continue;
    out.add_face(of_fan[fans.find(side)], of_fan[fans.find(side + 1)], of_fan[fans.find(side + 2)]);
  }
  for (const auto v : out.vertices()) {
    const std::uint32_t point = result.point[static_cast<std::size_t>(v.idx())];
    const bool stays =
        (!options.kept.empty() && options.kept[point]) ||
        std::ranges::binary_search(options.fixed, mesh.vertices_nm[point], is_before);
    if (stays || out.is_boundary(v) || out.valence(v) > max_valence) out.status(v).set_locked(true);
  }
  return result;
}

class Decimation {
 public:
  Decimation(const TriangleMesh& original, const DecimateOptions& options)
      : original_(original), options_(options), middle_(bounds(original).center_nm()),
        halfedges_(to_halfedges(original, middle_, options)), mesh_(halfedges_.mesh),
        left_(mesh_.n_faces()), all_(left_), quadrics_(mesh_.n_vertices()),
        stamps_(mesh_.n_vertices(), 0) {
    if (options.tolerance_nm > 0)
      detail_.emplace(original, mesh_.n_faces(), options.tolerance_nm, options.watch);
    options.watch.check();
    for (const auto f : mesh_.faces()) add_quadric(f);
  }

  Decimated run() {
    if (options_.repeated.empty()) {
      for (const auto v : mesh_.vertices()) wait(v);
    } else {
      repeat();
    }
    while (!queue_.empty() && left_ > options_.triangles) {
      look();
      const Waiting next = queue_.top();
      queue_.pop();
      const VertexHandle v(static_cast<int>(next.vertex));
      if (stamps_[next.vertex] == next.stamp && !mesh_.status(v).deleted()) remove(v);
    }
    return {remaining(), std::move(done_)};
  }

 private:
  struct Waiting {
    double cost;
    std::uint32_t vertex, stamp;
    bool operator>(const Waiting& b) const {
      return std::tie(cost, vertex) > std::tie(b.cost, b.vertex);
    }
  };
  struct Choice {
    double cost;
    HalfedgeHandle halfedge;
  };

  static std::size_t number(const OpenMesh::BaseHandle& h) {
    return static_cast<std::size_t>(h.idx());
  }

  void add_quadric(HalfedgeMesh::FaceHandle f) {
    VertexHandle v[3];
    std::size_t k = 0;
    for (const auto corner : mesh_.fv_range(f)) v[k++] = corner;
    const OpenMesh::Vec3d p = mesh_.point(v[0]);
    OpenMesh::Vec3d n = (mesh_.point(v[1]) - p) % (mesh_.point(v[2]) - p);
    const double area = n.norm();
    if (!(area > 0)) return;
    n /= area;
    Quadric q(n[0], n[1], n[2], -(p | n));
    q *= 0.5 * area;
    for (const VertexHandle corner : v) quadrics_[number(corner)] += q;
  }

  double cost(HalfedgeHandle h) const {
    const VertexHandle v = mesh_.from_vertex_handle(h), w = mesh_.to_vertex_handle(h);
    const OpenMesh::Vec3d& p = mesh_.point(w);
    const double squared = (mesh_.point(v) - p).sqrnorm();
    return std::max(0.0, quadrics_[number(v)](p) + quadrics_[number(w)](p)) +
           length_share * squared * squared;
  }

  /// Puts a vertex into the queue, or changes its place there.
  void wait(VertexHandle v) {
    const std::uint32_t stamp = ++stamps_[number(v)];
    if (mesh_.status(v).locked()) return;
    double least = HUGE_VAL;
    for (const auto h : mesh_.voh_range(v)) least = std::min(least, cost(h));
    if (least < HUGE_VAL) queue_.push({least, static_cast<std::uint32_t>(v.idx()), stamp});
  }

  /// Tries the neighbours in the order of their cost.
  void remove(VertexHandle v) {
    choices_.clear();
    for (const auto h : mesh_.voh_range(v)) choices_.push_back({cost(h), h});
    std::ranges::sort(choices_, [](const Choice& a, const Choice& b) {
      return std::pair(a.cost, a.halfedge.idx()) < std::pair(b.cost, b.halfedge.idx());
    });
    for (const Choice& c : choices_)
      if (is_possible(c.halfedge)) {
        perform(c.halfedge);
        return;
      }
  }

  bool is_possible(HalfedgeHandle h) {
    const VertexHandle v = mesh_.from_vertex_handle(h), w = mesh_.to_vertex_handle(h);
    const unsigned valence = mesh_.valence(v), other = mesh_.valence(w);
    if (valence + other > max_valence + 4 || (valence == 3 && other == 3)) return false;
    if (!mesh_.is_collapse_ok(h)) return false;
    return prepare(h) && (!detail_ || detail_->allows(merger_));
  }

  std::uint32_t point(VertexHandle v) const { return halfedges_.point[number(v)]; }
  Vec3 place(VertexHandle v) const { return original_.vertices_nm[point(v)]; }

  /// Fills `merger_`. Returns false if a face would turn over.
  bool prepare(HalfedgeHandle h) {
    const VertexHandle v = mesh_.from_vertex_handle(h), w = mesh_.to_vertex_handle(h);
    const Vec3 from = place(v), to = place(w);
    merger_.vertex = point(v);
    merger_.target = point(w);
    merger_.old_faces.clear();
    merger_.new_faces.clear();
    merger_.rim.clear();
    // Counter-clockwise from w: the face of each halfedge lies between it and the next.
    HalfedgeHandle at = h;
    do {
      const HalfedgeHandle next = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(at));
      const auto face = static_cast<std::uint32_t>(mesh_.face_handle(at).idx());
      merger_.old_faces.push_back(face);
      if (at != h && next != h) {
        const VertexHandle first = mesh_.to_vertex_handle(at),
                           second = mesh_.to_vertex_handle(next);
        const Vec3 a = place(first), b = place(second);
        const Vec3 normal = cross(a - to, b - to);
        if (!(dot(normal, cross(a - from, b - from)) > 0)) return false;
        if (!merger_.new_faces.empty()) merger_.rim.push_back(point(first));
        merger_.new_faces.push_back(
            {face, {merger_.target, point(first), point(second)}, {to, a, b}, normal});
      }
      at = next;
    } while (at != h);
    return true;
  }

  void perform(HalfedgeHandle h) {
    const VertexHandle v = mesh_.from_vertex_handle(h), w = mesh_.to_vertex_handle(h);
    if (detail_) detail_->perform(merger_);
    quadrics_[number(w)] += quadrics_[number(v)];
    done_.push_back({static_cast<std::uint32_t>(v.idx()), static_cast<std::uint32_t>(w.idx())});
    mesh_.collapse(h);
    left_ -= 2;
    if (repeating_) return;
    wait(w);
    for (const auto u : mesh_.vv_range(w)) wait(u);
  }

  void repeat() {
    repeating_ = true;
    std::vector<VertexHandle> changed;
    for (const Collapse& c : options_.repeated) {
      look();
      const VertexHandle v(static_cast<int>(c.from)), w(static_cast<int>(c.to));
      if (mesh_.status(v).deleted()) continue;
      if (!mesh_.status(v).locked() && !mesh_.status(w).deleted()) {
        const HalfedgeHandle h = mesh_.find_halfedge(v, w);
        if (h.is_valid() && is_possible(h)) {
          perform(h);
          continue;
        }
      }
      changed.push_back(v);
      for (const auto u : mesh_.vv_range(v)) changed.push_back(u);
    }
    repeating_ = false;
    for (const VertexHandle v : changed)
      if (!mesh_.status(v).deleted()) wait(v);
  }

  void look() {
    if (++looks_ % attempts_between_looks != 0) return;
    const double to_go = options_.triangles > 0
                             ? static_cast<double>(all_ - std::min(all_, options_.triangles))
                             : static_cast<double>(all_);
    options_.watch.report(std::min(static_cast<double>(all_ - left_), to_go), std::max(to_go, 1.0));
  }

  TriangleMesh remaining() const {
    TriangleMesh out{original_.vertices_nm, {}};
    out.triangles.reserve(left_);
    for (const auto f : mesh_.faces()) {  // those that are not deleted
      Triangle t{};
      std::size_t k = 0;
      for (const auto v : mesh_.fv_range(f)) t[k++] = point(v);
      out.triangles.push_back(t);
    }
    return out;
  }

  const TriangleMesh& original_;
  const DecimateOptions& options_;
  const Vec3 middle_;
  Halfedges halfedges_;
  HalfedgeMesh& mesh_;
  std::size_t left_, all_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> stamps_;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue_;
  std::optional<LeftOutDetail> detail_;
  std::vector<Choice> choices_;
  Merger merger_;
  std::vector<Collapse> done_;
  std::size_t looks_ = 0;
  bool repeating_ = false;
};

}  // namespace

bool is_before(const Vec3& a, const Vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

Decimated decimate(const TriangleMesh& mesh, const DecimateOptions& options) {
  return Decimation(mesh, options).run();
}

}  // namespace surf
