// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/vertex_curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "mesh/edges.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr std::size_t points_per_unit = 4096;
// Relative to the mean square of the terms; it matters only for otherwise undetermined terms.
constexpr double ridge = 1e-9;

/// z = p0 x + p1 y + p2 x^2 / 2 + p3 x y + p4 y^2 / 2 + p5.
using Quadric = std::array<double, 6>;

/// Least squares by the normal equations. Only the lower triangle is summed; the ridge makes them
/// positive definite.
class QuadricFit {
 public:
  void add(double x, double y, double z) {
    const Quadric term{x, y, x * x / 2, x * y, y * y / 2, 1};
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j <= i; ++j) a_[i][j] += term[i] * term[j];
      b_[i] += term[i] * z;
    }
  }

  Quadric solve() {
    double trace = 0;
    for (std::size_t i = 0; i < 6; ++i) trace += a_[i][i];
    for (std::size_t i = 0; i < 6; ++i) a_[i][i] += ridge * trace / 6;
    for (std::size_t j = 0; j < 6; ++j) {
      for (std::size_t k = 0; k < j; ++k) a_[j][j] -= a_[j][k] * a_[j][k];
      a_[j][j] = std::sqrt(a_[j][j]);
      for (std::size_t i = j + 1; i < 6; ++i) {
        for (std::size_t k = 0; k < j; ++k) a_[i][j] -= a_[i][k] * a_[j][k];
        a_[i][j] /= a_[j][j];
      }
    }
    Quadric p = b_;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < i; ++k) p[i] -= a_[i][k] * p[k];
      p[i] /= a_[i][i];
    }
    for (std::size_t i = 6; i-- > 0;) {
      for (std::size_t k = i + 1; k < 6; ++k) p[i] -= a_[k][i] * p[k];
      p[i] /= a_[i][i];
    }
    return p;
  }

 private:
  std::array<Quadric, 6> a_{};
  Quadric b_{};
};

double mean_curvature_of(const Quadric& p) {
  const double u = p[0], v = p[1];
  const double up = ((1 + v * v) * p[2] - 2 * u * v * p[3] + (1 + u * u) * p[4]) /
                    (2 * std::pow(1 + u * u + v * v, 1.5));
  return -up;
}

struct Net {
  std::vector<Vec3> place, normal;
  Buckets neighbours;  // of every point, some of them twice
};

Net make_net(const TriangleMesh& mesh, const Weld& weld) {
  Net net;
  const std::vector<Triangle> triangles = welded_triangles(mesh, weld);
  for (const std::uint32_t v : weld.first_vertex) net.place.push_back(mesh.vertices_nm[v]);
  net.normal.resize(net.place.size());
  for (const Triangle& t : triangles) {
    const Vec3 n = cross(net.place[t[1]] - net.place[t[0]], net.place[t[2]] - net.place[t[0]]);
    for (const std::uint32_t p : t) net.normal[p] += n;
  }
  net.neighbours = gather(net.place.size(), [&](const auto& put) {
    for (const Triangle& t : triangles) {
      if (has_repeated_corner(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        put(t[k], t[(k + 1) % 3]);
        put(t[k], t[(k + 2) % 3]);
      }
    }
  });
  return net;
}

/// Collects the points up to two edges away, including the point itself, each once. A point two
/// edges away must face the same way, because it may lie on the other side of a thin body.
void collect(const Net& net, std::uint32_t point, std::vector<std::uint32_t>& out) {
  const auto add_neighbours = [&](std::uint32_t p) {
    for (std::size_t i = net.neighbours.begin[p]; i < net.neighbours.begin[p + 1]; ++i)
      out.push_back(static_cast<std::uint32_t>(net.neighbours.values[i]));
  };
  out.assign(1, point);
  add_neighbours(point);
  const std::size_t near = out.size();
  for (std::size_t i = 1; i < near; ++i) add_neighbours(out[i]);
  const auto far = out.begin() + static_cast<std::ptrdiff_t>(near);
  out.erase(
      std::remove_if(far, out.end(),
                     [&](std::uint32_t q) { return !(dot(net.normal[q], net.normal[point]) > 0); }),
      out.end());
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

double curvature_at(const Net& net, std::uint32_t point, std::vector<std::uint32_t>& scratch) {
  const double size = length(net.normal[point]);
  if (!(size > 0)) return 0;
  const Vec3 n = net.normal[point] * (1 / size);
  const Vec3 away = std::abs(n.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 e = normalized(cross(n, away)), f = cross(n, e);
  collect(net, point, scratch);
  double radius = 0;
  for (const std::uint32_t q : scratch)
    radius = std::max(radius, length(net.place[q] - net.place[point]));
  if (!(radius > 0)) return 0;
  QuadricFit fit;
  for (const std::uint32_t q : scratch) {
    const Vec3 d = (net.place[q] - net.place[point]) * (1 / radius);
    fit.add(dot(d, e), dot(d, f), dot(d, n));
  }
  return mean_curvature_of(fit.solve()) / radius;
}

}  // namespace

std::vector<float> mean_curvature(const TriangleMesh& mesh, int threads, const Watch& watch) {
  validate(mesh);
  watch.report(0.05, 1);
  const Weld weld = weld_equal_vertices(mesh);
  watch.report(0.1, 1);
  const Net net = make_net(mesh, weld);
  watch.report(0.3, 1);
  const int workers = resolve_threads(threads);
  std::vector<std::vector<std::uint32_t>> scratch(static_cast<std::size_t>(workers));
  std::vector<float> of_point(weld.points());
  parallel_for((of_point.size() + points_per_unit - 1) / points_per_unit, workers,
               [&](std::size_t unit, int worker) {
                 const std::size_t end = std::min(of_point.size(), (unit + 1) * points_per_unit);
                 for (std::size_t p = unit * points_per_unit; p < end; ++p)
                   of_point[p] =
                       static_cast<float>(curvature_at(net, static_cast<std::uint32_t>(p),
                                                       scratch[static_cast<std::size_t>(worker)]));
               },
               watch.part(0.3, 1));
  std::vector<float> result(mesh.vertices_nm.size(), 0);
  for (std::size_t v = 0; v < result.size(); ++v)
    if (weld.point[v] != Weld::unused) result[v] = of_point[weld.point[v]];
  return result;
}

}  // namespace surf
