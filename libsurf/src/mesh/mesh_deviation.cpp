// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/mesh_deviation.h"

#include <cmath>
#include <vector>

#include "core/argument.h"
#include "surf/core/parallel.h"
#include "surf/mesh/triangle_tree.h"

namespace surf {
namespace {

constexpr std::size_t block_size = 1024;
// In mean edges: about the longest side of a typical triangle.
constexpr double default_spacing = 1.5;
// Largest number of pieces of a side; longer sides are sampled less densely than wanted.
constexpr double max_pieces = 4096;

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& v = mesh.vertices_nm;
    sum += length(v[b] - v[a]) + length(v[c] - v[b]) + length(v[a] - v[c]);
  }
  return sum / (3 * static_cast<double>(mesh.triangles.size()));
}

int pieces(double length_nm, double spacing_nm) {
  return static_cast<int>(std::clamp(std::ceil(length_nm / spacing_nm), 1.0, max_pieces));
}

/// Visits the sample points between the corners, in rows along the longest side.
template <class Visit>
void visit_samples(const TriangleMesh& mesh, const Triangle& t, double spacing_nm,
                   const Visit& visit) {
  Vec3 v[] = {mesh.vertices_nm[t[0]], mesh.vertices_nm[t[1]], mesh.vertices_nm[t[2]]};
  for (int turn = 0;
       turn < 2 && length(v[1] - v[0]) < std::max(length(v[2] - v[1]), length(v[0] - v[2]));
       ++turn) {
    std::rotate(v, v + 1, v + 3);
  }
  const Vec3 along = v[1] - v[0], up = v[2] - v[0];
  const double longest = length(along);
  const double height = longest > 0 ? length(cross(along, up)) / longest : 0;
  const int rows = pieces(height, spacing_nm);
  for (int row = 0; row < rows; ++row) {
    const double share = double(row) / rows;
    const int columns = pieces(longest * (1 - share), spacing_nm);
    const bool corners = row == 0;  // the ends are corners, already visited
    for (int column = corners; column <= columns - corners; ++column) {
      visit(v[0] + up * share + along * ((1 - share) * column / columns));
    }
  }
}

/// The largest distance of samples on `from` from the surface in the tree.
double largest_distance(const TriangleMesh& from, const TriangleTree& tree, double spacing_nm,
                        int threads, const Watch& watch) {
  const std::size_t corners = from.vertices_nm.size();
  const std::size_t count = corners + from.triangles.size();
  const std::size_t blocks = (count + block_size - 1) / block_size;
  std::vector<double> largest(blocks, 0);
  parallel_for(
      blocks, threads,
      [&](std::size_t block, int) {
        std::uint32_t near = 0;
        const auto look = [&](const Vec3& p) {
          const TriangleTree::Closest found = tree.closest(p, near);
          near = found.triangle;
          largest[block] = std::max(largest[block], found.distance_nm);
        };
        const std::size_t end = std::min(count, (block + 1) * block_size);
        for (std::size_t i = block * block_size; i < end; ++i) {
          if (i < corners) look(from.vertices_nm[i]);
          else visit_samples(from, from.triangles[i - corners], spacing_nm, look);
        }
      },
      watch);
  return largest.empty() ? 0 : *std::ranges::max_element(largest);
}

}  // namespace

MeshDeviation mesh_deviation(const TriangleMesh& first, const TriangleMesh& second,
                             const MeshDeviationOptions& options) {
  require_not_negative(options.spacing_nm, "sample spacing");
  validate(first);
  validate(second);
  MeshDeviation d;
  const Watch& watch = options.watch;
  watch.check();
  const TriangleMesh a = merge_equal_vertices(first), b = merge_equal_vertices(second);
  d.spacing_nm = options.spacing_nm > 0 ? options.spacing_nm
                                        : default_spacing * std::min(mean_edge(a), mean_edge(b));
  const auto from = [&](const TriangleMesh& one, const TriangleMesh& other, double begin) {
    watch.report(begin, 1);
    const TriangleTree tree(other, watch, options.threads);
    return largest_distance(one, tree, d.spacing_nm, options.threads,
                            watch.part(begin + 0.1, begin + 0.5));
  };
  d.from_first_nm = from(a, b, 0);
  d.from_second_nm = from(b, a, 0.5);
  return d;
}

}  // namespace surf
