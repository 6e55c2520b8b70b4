// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/self_intersections.h"

#include <algorithm>

#include "mesh/cgal_predicates.h"
#include "mesh/edges.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/mesh/triangle_tree.h"

namespace surf {
namespace {

using Pair = std::array<std::uint32_t, 2>;

constexpr std::size_t block_size = 4096;    // triangles per unit of work
constexpr std::size_t blocks_a_round = 64;  // between checks of the limit

/// Tests whether two triangles of a welded mesh meet beyond their shared corners.
class Meeting {
 public:
  Meeting(const TriangleTree& tree, std::vector<Triangle> points)
      : tree_(tree), points_(std::move(points)) {}

  bool operator()(std::uint32_t s, std::uint32_t t) const {
    std::size_t shared = 0;
    std::array<std::size_t, 3> in_s{}, in_t{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (points_[s][i] != points_[t][k]) continue;
        in_s[shared] = i;
        in_t[shared++] = k;
      }
    }
    switch (shared) {
      case 0:
        return triangles_meet(tree_.corners(s), tree_.corners(t));
      case 1:
        return triangles_meet_beyond_corner(from(s, in_s[0], (in_s[0] + 1) % 3),
                                            from(t, in_t[0], (in_t[0] + 1) % 3));
      case 2:
        return triangles_meet_beyond_edge(from(s, in_s[0], in_s[1]), from(t, in_t[0], in_t[1]));
      default:
        return true;  // the same triangle twice
    }
  }

 private:
  /// The corners of a triangle, corner `a` first and corner `b` second.
  Corners from(std::uint32_t t, std::size_t a, std::size_t b) const {
    const Corners corners = tree_.corners(t);
    const Vec3 v[] = {corners.a, corners.b, corners.c};
    return {v[a], v[b], v[3 - a - b]};
  }

  const TriangleTree& tree_;
  const std::vector<Triangle> points_;
};

Vec3 middle_of_overlap(const Box& a, const Box& b) {
  const auto middle = [](double al, double ah, double bl, double bh) {
    return 0.5 * (std::max(al, bl) + std::min(ah, bh));
  };
  return {middle(a.lower_nm.x, a.upper_nm.x, b.lower_nm.x, b.upper_nm.x),
          middle(a.lower_nm.y, a.upper_nm.y, b.lower_nm.y, b.upper_nm.y),
          middle(a.lower_nm.z, a.upper_nm.z, b.lower_nm.z, b.upper_nm.z)};
}

}  // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh,
                                          const SelfIntersectionOptions& options) {
  if (options.limit == 0) throw UsageError("limit", "it is 0", "Give 1 or more");
  validate(mesh);
  const Watch& watch = options.watch;
  watch.check();
  const TriangleTree tree(mesh, watch, options.threads);
  const std::size_t triangles = mesh.triangles.size();
  const Meeting meet(tree, welded_triangles(mesh, weld_equal_vertices(mesh)));
  std::vector<unsigned char> flat(triangles);
  parallel_for((triangles + block_size - 1) / block_size, options.threads,
               [&](std::size_t b, int) {
                 const std::size_t end = std::min(triangles, (b + 1) * block_size);
                 for (std::size_t t = b * block_size; t < end; ++t) {
                   flat[t] = is_degenerate(tree.corners(static_cast<std::uint32_t>(t)));
                 }
               },
               Watch{{}, watch.cancel});

  constexpr double searching_from = 0.2;  // share of the progress
  watch.report(searching_from, 1);
  SelfIntersections result;
  std::vector<std::vector<Pair>> found;
  const std::size_t round = blocks_a_round * block_size;
  for (std::size_t begin = 0; begin < triangles; begin += round) {
    const std::size_t blocks = (std::min(round, triangles - begin) + block_size - 1) / block_size;
    found.resize(blocks);
    parallel_for(
        blocks, options.threads,
        [&](std::size_t b, int) {
          found[b].clear();
          const std::size_t last = std::min(triangles, begin + (b + 1) * block_size);
          for (std::size_t i = begin + b * block_size; i < last; ++i) {
            const auto s = static_cast<std::uint32_t>(i);
            if (flat[s]) continue;
            tree.visit_overlapping(tree.box_of(s), [&](std::uint32_t t) {
              if (t > s && !flat[t] && meet(s, t)) found[b].push_back({s, t});
            });
            if (found[b].size() >= options.limit) break;
          }
          std::ranges::sort(found[b]);
        },
        Watch{{}, watch.cancel});
    const double done =
        static_cast<double>(std::min(begin + round, triangles)) / static_cast<double>(triangles);
    watch.report(searching_from + (1 - searching_from) * done, 1);
    for (const std::vector<Pair>& pairs : found) {
      result.pairs.insert(result.pairs.end(), pairs.begin(), pairs.end());
    }
    if (result.pairs.size() < options.limit) continue;
    result.pairs.resize(options.limit);
    result.complete = false;
    break;
  }
  if (!result.pairs.empty()) {
    const auto [s, t] = result.pairs.front();
    result.first_nm = middle_of_overlap(tree.box_of(s), tree.box_of(t));
  }
  return result;
}

}  // namespace surf
