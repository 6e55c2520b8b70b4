// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/refinement/mesh_modes.h"

#include <algorithm>
#include <cmath>

namespace surf {

std::vector<std::vector<std::size_t>> groups_apart(const std::vector<MeshMode>& modes,
                                                   double margin_nm) {
  std::vector<std::vector<std::size_t>> groups;
  const auto touch = [&](std::size_t a, std::size_t b) {
    return length(modes[a].middle_nm - modes[b].middle_nm) <
           modes[a].reach_nm + modes[b].reach_nm + margin_nm;
  };
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const auto has_room = [&](const std::vector<std::size_t>& group) {
      return modes[k].is_bump() && std::ranges::all_of(group, [&](std::size_t other) {
               return modes[other].is_bump() && !touch(k, other);
             });
    };
    const auto group = std::ranges::find_if(groups, has_room);
    if (group == groups.end()) groups.push_back({k});
    else group->push_back(k);
  }
  return groups;
}

TriangleMesh moved(const TriangleMesh& mesh, const std::vector<MeshMode>& modes,
                   std::span<const double> amplitudes_nm) {
  TriangleMesh out = mesh;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (amplitudes_nm[k] == 0) continue;
    for (const MeshMode::Move& move : modes[k].moves)
      out.vertices_nm[move.vertex] += move.by * amplitudes_nm[k];
  }
  return out;
}

std::vector<double> prior_covariance(const std::vector<MeshMode>& modes, const ModePrior& prior) {
  constexpr double normals_apart = 0.7;  // length of a difference of normals that parts bumps
  constexpr double own = 1e-4;           // of each bump alone, so that the matrix can be inverted
  const std::size_t n = modes.size();
  std::vector<double> out(n * n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    if (!modes[k].is_bump()) {
      // Half an amplitude up, half down.
      const double off = modes[k].vertical ? 0.5 * prior.height_nm : prior.smooth_nm;
      out[k * n + k] = off * off;
      continue;
    }
    for (std::size_t l = 0; l < n; ++l) {
      if (!modes[l].is_bump()) continue;
      const double far = length(modes[k].middle_nm - modes[l].middle_nm) / prior.length_nm,
                   turned = length(modes[k].normal - modes[l].normal) / normals_apart;
      const double correlation = std::exp(-0.5 * (far * far + turned * turned));
      out[k * n + l] = prior.bump_nm * prior.bump_nm * (correlation + (k == l ? own : 0));
    }
  }
  return out;
}

}  // namespace surf
