// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/boundary.h"

namespace surf {
namespace {

/// Unpaired sides: at an edge that n sides traverse in one direction and m < n in the other, the
/// last n - m of the former.
std::vector<Side> open_sides(const std::vector<Triangle>& triangles, std::size_t points) {
  std::vector<Side> open;
  visit_edges(triangles, points, [&](const EdgeUse& edge) {
    const std::size_t forward = count_forward(triangles, edge);
    const std::size_t backward = edge.uses() - forward;
    if (forward == backward) return;
    const bool extra_forward = forward > backward;
    std::size_t answered = std::min(forward, backward);
    for (std::size_t i = 0; i < edge.uses(); ++i) {
      if ((side_begin(triangles, edge.side(i)) == edge.low) != extra_forward) continue;
      if (answered > 0) --answered;
      else open.push_back(edge.side(i));
    }
  });
  std::ranges::sort(open);
  return open;
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const std::vector<Triangle>& triangles,
                                         std::size_t points) {
  const std::vector<Side> open = open_sides(triangles, points);
  // For each point, the open sides that begin there, as a linked list of indices into `open`, in
  // order.
  constexpr std::uint32_t none = Weld::unused;
  std::vector<std::uint32_t> head(points, none), next(open.size(), none);
  for (std::size_t i = open.size(); i-- > 0;) {
    std::uint32_t& first = head[side_begin(triangles, open[i])];
    next[i] = first;
    first = static_cast<std::uint32_t>(i);
  }
  const auto take = [&](std::uint32_t point) {
    const std::uint32_t i = head[point];
    if (i != none) head[point] = next[i];
    return i;
  };

  std::vector<BoundaryLoop> loops;
  std::vector<std::uint32_t> position(points, none);  // index on the current path
  for (const Side start : open) {
    std::vector<Side> path;
    std::uint32_t point = side_begin(triangles, start);
    while (true) {
      if (position[point] != none) {
        // The path has returned to one of its points: the part since then is a loop.
        const auto from = path.begin() + position[point];
        BoundaryLoop loop;
        loop.sides.assign(from, path.end());
        for (const Side s : loop.sides) {
          loop.points.push_back(side_begin(triangles, s));
          position[loop.points.back()] = none;
        }
        path.erase(from, path.end());
        loops.push_back(std::move(loop));
      }
      const std::uint32_t i = take(point);
      if (i == none) break;
      position[point] = static_cast<std::uint32_t>(path.size());
      path.push_back(open[i]);
      point = side_end(triangles, open[i]);
    }
    for (const Side s : path) position[side_begin(triangles, s)] = none;
  }
  return loops;
}

}  // namespace surf
