// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/simplify_mesh.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/argument.h"
#include "mesh/edges.h"
#include "mesh/one_sided_bound.h"
#include "mesh/openmesh_decimate.h"
#include "surf/core/error.h"

namespace surf {
namespace {

// Each restores vertices in a wider surrounding than the one before.
constexpr int most_attempts = 8;
// Of the tolerance: what decimation aims at, so that proofs have some room.
constexpr double aimed_share = 0.998;

DecimateOptions decimation_of(const SimplifyOptions& options) {
  DecimateOptions d;
  d.tolerance_nm = aimed_share * options.tolerance_nm;
  d.triangles = options.triangles;
  d.fixed = options.fixed_nm;
  std::ranges::sort(d.fixed, is_before);
  return d;
}

/// Decimates, and restores what cannot be proven, until the tolerance is proven.
class ProvenDecimation {
 public:
  ProvenDecimation(const TriangleMesh& original, const SimplifyOptions& options,
                   SimplifySummary& summary)
      : original_(original), options_(options), summary_(summary),
        original_tree_(original, options.watch, options.threads) {}

  /// Empty if nothing was proven.
  TriangleMesh run() {
    std::vector<std::uint8_t> kept(original_.vertices_nm.size(), 0);
    std::vector<Collapse> done;
    DecimateOptions decimation = decimation_of(options_);
    for (; summary_.attempts < most_attempts; ++summary_.attempts) {
      // The number of attempts is not known, so each gets three quarters of the remaining progress.
      const double from = 1 - std::pow(0.25, summary_.attempts);
      const Watch watch = options_.watch.part(from, 0.75 + 0.25 * from);
      decimation.watch = watch.part(0, 0.6);
      decimation.kept = kept;
      decimation.repeated = done;
      Decimated next = decimate(original_, decimation);
      TriangleMesh simple = merge_equal_vertices(next.mesh);
      if (simple.triangles.empty()) return {};
      const std::vector<std::uint32_t> unproven = prove(simple, watch.part(0.6, 1));
      if (unproven.empty()) {
        ++summary_.attempts;
        return simple;
      }
      summary_.restored += unproven.size();
      keep(unproven, (1 << summary_.attempts) - 1, kept);
      done = std::move(next.collapses);
    }
    return {};
  }

 private:
  /// Returns the triangles of the original near which the tolerance is not proven.
  std::vector<std::uint32_t> prove(const TriangleMesh& simple, const Watch& watch) {
    const BoundAim aim{.enough_nm = negligible_distance_nm(original_, simple),
                       .limit_nm = options_.tolerance_nm};
    const TriangleTree tree(simple, watch, options_.threads);
    OneSidedBound there =
        bound_one_side(original_, tree, aim, options_.threads, watch.part(0.1, 0.5));
    const OneSidedBound back =
        bound_one_side(simple, original_tree_, aim, options_.threads, watch.part(0.5, 1));
    summary_.deviation = {there.bound_nm, back.bound_nm};
    std::vector<std::uint32_t> near;
    // Of all that is too far from one new triangle the farthest: a vertex more may be enough.
    std::ranges::sort(there.unproven, [](const Unproven& a, const Unproven& b) {
      return std::tuple(a.nearest, -a.distance_nm, a.triangle) <
             std::tuple(b.nearest, -b.distance_nm, b.triangle);
    });
    const auto others =
        std::unique(there.unproven.begin(), there.unproven.end(),
                    [](const Unproven& a, const Unproven& b) { return a.nearest == b.nearest; });
    there.unproven.erase(others, there.unproven.end());
    for (const Unproven& u : there.unproven) near.push_back(u.triangle);
    for (const Unproven& u : back.unproven) near.push_back(u.nearest);
    return near;
  }

  /// Adds the vertices of these triangles and those up to `rings` edges away.
  void keep(const std::vector<std::uint32_t>& triangles, int rings,
            std::vector<std::uint8_t>& kept) const {
    std::vector<std::uint8_t> inside(original_.vertices_nm.size(), 0);
    for (const std::uint32_t t : triangles)
      for (const std::uint32_t v : original_.triangles[t]) inside[v] = 1;
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<std::uint8_t> wider = inside;
      for (const auto& [a, b, c] : original_.triangles)
        if (inside[a] || inside[b] || inside[c]) wider[a] = wider[b] = wider[c] = 1;
      inside = std::move(wider);
    }
    for (std::size_t v = 0; v < kept.size(); ++v) kept[v] |= inside[v];
  }

  const TriangleMesh& original_;
  const SimplifyOptions& options_;
  SimplifySummary& summary_;
  const TriangleTree original_tree_;
};

/// Decimates to a number of triangles, and bounds the distance.
TriangleMesh decimated(const TriangleMesh& original, const SimplifyOptions& options,
                       SimplifySummary& summary) {
  DecimateOptions decimation = decimation_of(options);
  decimation.watch = options.watch.part(0, 0.7);
  TriangleMesh simple = merge_equal_vertices(decimate(original, decimation).mesh);
  summary.attempts = 1;
  if (simple.triangles.empty()) return simple;
  summary.deviation = bound_distance(
      original, simple, {.threads = options.threads, .watch = options.watch.part(0.7, 1)});
  return simple;
}

TriangleMesh merged(const TriangleMesh& mesh) {
  TriangleMesh merged = merge_equal_vertices(mesh);
  if (std::erase_if(merged.triangles, has_repeated_corner) == 0) return merged;
  return merge_equal_vertices(merged);
}

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
  TriangleMesh original = merged(mesh), result;
  if (original.triangles.empty())
    throw InvalidInput("mesh", "every triangle has a corner twice: there is no surface",
                       "Give a mesh with triangles that have an area");
  const bool to_do = original.triangles.size() > std::max<std::size_t>(options.triangles, 4);
  if (to_do)
    result = options.tolerance_nm > 0 ? ProvenDecimation(original, options, summary).run()
                                      : decimated(original, options, summary);
  if (result.triangles.empty()) {
    if (to_do) summary.end = SimplifyEnd::not_proven;
    result = std::move(original);
    summary.deviation = {};
  }
  summary.triangles_after = result.triangles.size();
  summary.reached = options.triangles == 0 || result.triangles.size() <= options.triangles;
  if (options.triangles > 0 && summary.reached) summary.end = SimplifyEnd::triangles;
  return {std::move(result), summary};
}

}  // namespace surf
