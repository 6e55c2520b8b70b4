// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/repair_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/argument.h"
#include "mesh/cgal_resolve.h"
#include "mesh/repair_holes.h"
#include "mesh/repair_steps.h"
#include "surf/core/units.h"
#include "surf/mesh/self_intersections.h"

namespace surf {
namespace {

constexpr double default_stitch = 1e-6;          // share of the diagonal
constexpr std::size_t max_mended_pairs = 20000;  // with more, CGAL would take minutes
// A repaired body keeps at least this share of its volume, a sheet of its area.
constexpr double size_kept = 0.5;

void check_options(const RepairOptions& o) {
  if (o.stitch_nm) require_not_negative(*o.stitch_nm, "stitch distance");
  require_not_negative(o.sliver_nm, "sliver height");
  if (o.max_hole_nm) require_not_negative(*o.max_hole_nm, "longest hole");
  require_not_negative(o.min_component_nm, "smallest component");
}

std::size_t edge_faults(const MeshReport& r) {
  return r.boundary_edges + r.nonmanifold_edges + r.inconsistent_edges;
}

bool no_worse(const MeshReport& now, const MeshReport& before) {
  return now.triangles > 0 && edge_faults(now) <= edge_faults(before) &&
         (now.closed_and_oriented || !before.closed_and_oriented);
}

/// The mesh during the repair, and the current report of `check_mesh`.
class Work {
 public:
  Work(TriangleMesh mesh, const Watch& watch)
      : watch_(&watch), mesh_(std::move(mesh)), report_(check_mesh(mesh_, *watch_)) {}

  const TriangleMesh& mesh() const { return mesh_; }
  const MeshReport& report() const { return report_; }

  /// Runs a step and keeps its result unless it is worse. Returns the number of repairs.
  std::size_t step(const std::function<std::size_t(TriangleMesh&)>& work) {
    watch_->check();
    TriangleMesh next = mesh_;
    const std::size_t count = work(next);
    watch_->check();
    if (count == 0) return 0;
    const MeshReport report = check_mesh(next, *watch_);
    if (!no_worse(report, report_)) return 0;
    mesh_ = std::move(next);
    report_ = report;
    return count;
  }

 private:
  const Watch* watch_;  // for cancellation only
  TriangleMesh mesh_;
  MeshReport report_;
};

bool fits_in(const Box& inner, const Box& outer) {
  const double slack = 1e-6 * length(outer.size_nm());
  return inner.lower_nm.x >= outer.lower_nm.x - slack &&
         inner.lower_nm.y >= outer.lower_nm.y - slack &&
         inner.lower_nm.z >= outer.lower_nm.z - slack &&
         inner.upper_nm.x <= outer.upper_nm.x + slack &&
         inner.upper_nm.y <= outer.upper_nm.y + slack &&
         inner.upper_nm.z <= outer.upper_nm.z + slack;
}

/// Unites the bodies that intersect each other; the rest of the mesh stays as it is.
TriangleMesh united(const TriangleMesh& mesh, const SelfIntersections& crossings,
                    const Watch& watch) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  std::vector<unsigned char> crosses;
  crosses.assign(*std::ranges::max_element(component) + 1, 0);
  for (const auto& [s, t] : crossings.pairs) {
    if (component[s] == component[t]) continue;
    crosses[component[s]] = crosses[component[t]] = 1;
  }
  std::vector<TriangleMesh> bodies;
  TriangleMesh rest{mesh.vertices_nm, {}};
  std::vector<std::size_t> number(crosses.size());
  for (std::size_t c = 0; c < crosses.size(); ++c) {
    number[c] = bodies.size();
    if (crosses[c]) bodies.push_back(rest);
  }
  if (bodies.size() < 2) return {};
  for (std::size_t t = 0; t < component.size(); ++t) {
    TriangleMesh& home = crosses[component[t]] ? bodies[number[component[t]]] : rest;
    home.triangles.push_back(mesh.triangles[t]);
  }
  for (TriangleMesh& body : bodies) {
    body = merge_equal_vertices(body);
    const MeshReport r = check_mesh(body, watch);
    if (!r.closed_and_oriented || r.signed_volume_nm3 <= 0) return {};
  }
  const TriangleMesh sum = unite(bodies, watch);
  if (sum.triangles.empty()) return {};
  const auto first = static_cast<std::uint32_t>(rest.vertices_nm.size());
  rest.vertices_nm.insert(rest.vertices_nm.end(), sum.vertices_nm.begin(), sum.vertices_nm.end());
  for (const auto& [a, b, c] : sum.triangles)
    rest.triangles.push_back({first + a, first + b, first + c});
  return merge_equal_vertices(rest);
}

/// Accepts a repaired mesh if it is better and still the same body.
bool adopt(TriangleMesh& mesh, SelfIntersections& found, TriangleMesh mended, int threads,
           const Watch& watch) {
  if (mended.triangles.empty()) return false;
  mended = merge_equal_vertices(mended);
  remove_degenerate(mended, 0);
  if (mended.triangles.empty()) return false;
  const MeshReport before = check_mesh(mesh, watch);
  const MeshReport now = check_mesh(mended, watch);
  if (!no_worse(now, before) || now.degenerate_triangles > before.degenerate_triangles)
    return false;
  if (!fits_in(now.bounds_nm, before.bounds_nm)) return false;
  if (now.area_nm2 < size_kept * before.area_nm2 && !before.closed_and_oriented) return false;
  if (now.signed_volume_nm3 < size_kept * before.signed_volume_nm3) return false;
  SelfIntersections left = find_self_intersections(mended, {.threads = threads, .watch = watch});
  if (left.pairs.size() >= found.pairs.size()) return false;
  mesh = std::move(mended);
  found = std::move(left);
  return true;
}

std::size_t resolve(TriangleMesh& mesh, SelfIntersections& found, int threads, const Watch& watch) {
  if (found.pairs.size() > max_mended_pairs) return 0;
  const std::size_t before = found.pairs.size();
  if (check_mesh(mesh, watch).closed_and_oriented)
    adopt(mesh, found, united(mesh, found, watch), threads, watch);
  if (!found.pairs.empty())
    adopt(mesh, found, mend_self_intersections(mesh, watch), threads, watch);
  return before - found.pairs.size();
}

std::size_t count_used_vertices(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> point = weld_equal_vertices(mesh).point;
  return mesh.vertices_nm.size() -
         static_cast<std::size_t>(std::ranges::count(point, Weld::unused));
}

std::string count(std::size_t n, const char* noun, const char* plural = nullptr) {
  if (n == 1) return fmt::format("1 {}", noun);
  return plural ? fmt::format("{} {}", n, plural) : fmt::format("{} {}s", n, noun);
}

std::string place(const Vec3& p) {
  return fmt::format("near ({:.6g}, {:.6g}, {:.6g}) nm", p.x, p.y, p.z);
}

}  // namespace

bool RepairSummary::sound() const {
  return after.closed_and_oriented && after.signed_volume_nm3 > 0 &&
         after.degenerate_triangles + after.duplicate_triangles + self_intersections_after == 0;
}

RepairedMesh repair_mesh(const TriangleMesh& mesh, const RepairOptions& options) {
  check_options(options);
  validate(mesh);
  RepairSummary summary;
  const Watch& watch = options.watch;
  const Watch silent{{}, watch.cancel};
  summary.before = check_mesh(mesh, watch.part(0, 0.15));

  TriangleMesh merged = merge_equal_vertices(mesh);
  summary.merged_vertices = count_used_vertices(mesh) - merged.vertices_nm.size();
  Work work(std::move(merged), silent);
  watch.report(0.25, 1);
  const auto open = [&] { return work.report().boundary_edges > 0; };
  if (open()) {
    const double diagonal = length(work.report().bounds_nm.size_nm());
    const std::size_t rim = work.report().boundary_edges;
    Work stitched = work;
    const std::size_t stitches = stitched.step([&](TriangleMesh& m) {
      return stitch_rims(m, options.stitch_nm.value_or(default_stitch * diagonal));
    });
    if (stitches > 0 && stitched.report().boundary_edges < rim) {
      summary.stitched_vertices = stitches;
      work = std::move(stitched);
    }
  }
  watch.report(0.35, 1);
  const auto clean = [&] {
    summary.removed_degenerate +=
        work.step([&](TriangleMesh& m) { return remove_degenerate(m, options.sliver_nm); });
    if (work.report().duplicate_triangles > 0) {
      summary.removed_duplicates += work.step(remove_duplicates);
    }
  };
  clean();
  watch.report(0.45, 1);
  if (work.report().doubled_directed_edges > 0) summary.turned_triangles += work.step(orient);
  summary.dropped_components =
      work.step([&](TriangleMesh& m) { return drop_components(m, options.min_component_nm); });
  if (!work.report().closed_and_oriented) {
    std::size_t triangles = 0;
    summary.filled_holes = work.step(
        [&](TriangleMesh& m) { return fill_holes(m, options.max_hole_nm, triangles, silent); });
    if (summary.filled_holes > 0) summary.fill_triangles = triangles;
    clean();
  }
  watch.report(0.55, 1);
  summary.turned_triangles += work.step(turn_outward);

  SelfIntersections found = find_self_intersections(
      work.mesh(), {.threads = options.threads, .watch = watch.part(0.6, 0.8)});
  summary.self_intersections_before = found.pairs.size();
  if (!found.pairs.empty() && options.resolve_self_intersections) {
    work.step([&](TriangleMesh& m) { return resolve(m, found, options.threads, silent); });
  }
  watch.report(0.9, 1);
  summary.self_intersections_after = found.pairs.size();
  summary.first_self_intersection_nm = found.first_nm;

  summary.changed = summary.merged_vertices + summary.stitched_vertices +
                            summary.removed_degenerate + summary.removed_duplicates +
                            summary.turned_triangles + summary.dropped_components +
                            summary.filled_holes >
                        0 ||
                    summary.self_intersections_after < summary.self_intersections_before;
  summary.open_holes = open_holes(work.mesh(), options.max_hole_nm);
  if (!summary.changed) {
    summary.after = summary.before;
    return {mesh, std::move(summary)};
  }
  TriangleMesh result = merge_equal_vertices(work.mesh());
  summary.after = check_mesh(result, watch.part(0.95, 1));
  return {std::move(result), std::move(summary)};
}

std::vector<std::string> describe(const RepairSummary& s) {
  std::vector<std::string> lines;
  const auto did = [&](std::size_t n, const std::string& text) {
    if (n > 0) lines.push_back(text);
  };
  did(s.merged_vertices,
      "merged " + count(s.merged_vertices, "vertex", "vertices") + " at equal places");
  did(s.stitched_vertices, "stitched " + count(s.stitched_vertices, "rim vertex", "rim vertices"));
  did(s.removed_degenerate, "removed " + count(s.removed_degenerate, "triangle") + " without area");
  did(s.removed_duplicates, "removed " + count(s.removed_duplicates, "duplicate triangle"));
  did(s.turned_triangles, "turned " + count(s.turned_triangles, "triangle"));
  did(s.dropped_components, "dropped " + count(s.dropped_components, "small component"));
  did(s.filled_holes,
      "filled " + count(s.filled_holes, "hole") + " with " + count(s.fill_triangles, "triangle"));
  if (s.self_intersections_before > s.self_intersections_after) {
    lines.push_back("resolved " + count(s.self_intersections_before - s.self_intersections_after,
                                        "self-intersection"));
  }
  if (lines.empty()) lines.push_back("nothing to mend");

  constexpr std::size_t most_holes = 5;
  for (std::size_t i = 0; i < std::min(most_holes, s.open_holes.size()); ++i) {
    const OpenHole& h = s.open_holes[i];
    lines.push_back(fmt::format("left open: a hole of {} edges, {} round, {}{}", h.edges,
                                format_length(h.perimeter_nm), place(h.place_nm),
                                h.too_large ? "" : ", which nothing fits"));
  }
  if (s.open_holes.size() > most_holes) {
    lines.push_back(fmt::format("left open: {} more holes", s.open_holes.size() - most_holes));
  }
  if (s.self_intersections_after > 0) {
    lines.push_back(fmt::format("remains: {} {}",
                                count(s.self_intersections_after, "self-intersection"),
                                place(s.first_self_intersection_nm)));
  }
  for (const std::string& fault : faults(s.after)) lines.push_back("remains: " + fault);
  return lines;
}

}  // namespace surf
