// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/argument.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

void require_range(int value, int lowest, int highest, const char* subject) {
  if (value >= lowest && value <= highest) return;
  throw UsageError(subject, fmt::format("is {}", value),
                   fmt::format("Give a whole number from {} to {}", lowest, highest));
}

// ---- Box ------------------------------------------------------------------------------------

using Ticks = std::array<std::vector<double>, 3>;

std::vector<double> ticks(double lower, double upper, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(lower + (upper - lower) * i / count);
  values.push_back(upper);
  return values;
}

/// The side of the box across `axis`, its own vertices included; `high` is the upper one.
void add_side(TriangleMesh& mesh, const Ticks& t, std::size_t axis, bool high) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const auto first = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  const auto row = static_cast<std::uint32_t>(t[u].size());
  for (const double at_v : t[v]) {
    for (const double at_u : t[u]) {
      double p[3];
      p[axis] = high ? t[axis].back() : t[axis].front();
      p[u] = at_u;
      p[v] = at_v;
      mesh.vertices_nm.push_back({p[0], p[1], p[2]});
    }
  }
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + j * row + i;
      std::uint32_t b = a + 1;
      std::uint32_t d = a + row;
      const std::uint32_t c = d + 1;
      if (!high) std::swap(b, d);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
}

// ---- Sphere ---------------------------------------------------------------------------------

TriangleMesh icosahedron() {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices_nm = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& v : mesh.vertices_nm) v = normalized(v);
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Splits every triangle of a unit sphere in four, with one vertex per edge's middle.
TriangleMesh split_sphere(const TriangleMesh& coarse) {
  std::vector<std::uint64_t> edges;
  edges.reserve(coarse.triangles.size() * 3);
  for (const Triangle& t : coarse.triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(edge_key(t[k], t[(k + 1) % 3]));
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  TriangleMesh fine;
  fine.vertices_nm = coarse.vertices_nm;
  for (const std::uint64_t edge : edges) {
    fine.vertices_nm.push_back(normalized(coarse.vertices_nm[edge >> 32] +
                                          coarse.vertices_nm[edge & 0xffffffffu]));
  }
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto found = std::ranges::lower_bound(edges, edge_key(a, b));
    return static_cast<std::uint32_t>(coarse.vertices_nm.size() +
                                      static_cast<std::size_t>(found - edges.begin()));
  };
  fine.triangles.reserve(coarse.triangles.size() * 4);
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(),
                          {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

// ---- Height fields --------------------------------------------------------------------------

int sample_count(double length_nm, double pitch_nm, const char* subject) {
  require_positive(length_nm, subject);
  const double count = std::round(length_nm / pitch_nm) + 1;
  if (count >= 2 && count <= 65536) return static_cast<int>(count);
  throw UsageError(subject,
                   fmt::format("{} nm at a pitch of {} nm makes {:.6g} samples", length_nm,
                               pitch_nm, count),
                   "Choose both so that there are 2 to 65536");
}

HeightField flat_field(const FieldExtent& extent) {
  require_positive(extent.pitch_nm, "pitch");
  const int width = sample_count(extent.width_nm, extent.pitch_nm, "width");
  const int height = sample_count(extent.depth_nm, extent.pitch_nm, "depth");
  HeightField field;
  field.z_nm = Grid<double>(width, height);
  field.pitch_x_nm = field.pitch_y_nm = extent.pitch_nm;
  field.origin_x_nm = -0.5 * (width - 1) * extent.pitch_nm;
  field.origin_y_nm = -0.5 * (height - 1) * extent.pitch_nm;
  return field;
}

/// Distance of a sample from the middle of the field; exactly the same on both sides.
double from_middle(int index, int count, double pitch_nm) {
  return std::abs(index - 0.5 * (count - 1)) * pitch_nm;
}

/// 1 up to `half_width_nm` from the middle, falling to 0 over `run_nm`.
double ramp(double distance_nm, double half_width_nm, double run_nm) {
  return std::clamp(1 - (distance_nm - half_width_nm) / run_nm, 0.0, 1.0);
}

// ---- Rough surface --------------------------------------------------------------------------

// The finaliser of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014, doi:10.1145/2660193.2660195).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A standard normal number as a function of (seed, index), by Box and Muller.
double normal_number(std::uint64_t seed, std::uint64_t index) {
  constexpr std::uint64_t step = 0x9e3779b97f4a7c15u;
  const std::uint64_t start = mixed(seed + step);
  const auto uniform = [&](std::uint64_t i) {
    return (static_cast<double>(mixed(start + (i + 1) * step) >> 11) + 0.5) * 0x1p-53;
  };
  return std::sqrt(-2 * std::log(uniform(2 * index))) *
         std::cos(2 * std::numbers::pi * uniform(2 * index + 1));
}

/// The convolution of two equal kernels exp(-2 r^2 / L^2) is exp(-r^2 / L^2). At 3 L it is 2e-8.
std::vector<double> kernel(double correlation_nm, double pitch_nm) {
  const int reach = static_cast<int>(std::ceil(3 * correlation_nm / pitch_nm));
  std::vector<double> weights;
  for (int i = -reach; i <= reach; ++i) {
    const double r = i * pitch_nm / correlation_nm;
    weights.push_back(std::exp(-2 * r * r));
  }
  return weights;
}

/// Convolves every column with the weights, periodically, and returns the transpose: done twice, it
/// smooths along both axes and the inner loop always runs along memory.
Grid<double> smoothed_transpose(const Grid<double>& in, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size() / 2);
  const int width = in.width();
  const int height = in.height();
  Grid<double> out(height, width);
  parallel_for(static_cast<std::size_t>(height), 0, [&](std::size_t unit, int) {
    const int y = static_cast<int>(unit);
    std::vector<double> sum(static_cast<std::size_t>(width), 0.0);
    for (int k = -reach; k <= reach; ++k) {
      const double* const row = &in(0, ((y + k) % height + height) % height);
      const double weight = weights[static_cast<std::size_t>(k + reach)];
      for (std::size_t x = 0; x < sum.size(); ++x) sum[x] += weight * row[x];
    }
    for (int x = 0; x < width; ++x) out(y, x) = sum[static_cast<std::size_t>(x)];
  });
  return out;
}

double mean(const std::vector<double>& values, const std::function<double(double)>& f) {
  double sum = 0;
  for (const double value : values) sum += f(value);
  return sum / static_cast<double>(values.size());
}

}  // namespace

TriangleMesh make_box(const Vec3& lower_nm, const Vec3& upper_nm, int subdivisions) {
  require_range(subdivisions, 1, 10000, "subdivisions");
  const Vec3 size = upper_nm - lower_nm;
  require_positive(size.x, "size of the box along x");
  require_positive(size.y, "size of the box along y");
  require_positive(size.z, "size of the box along z");
  const Ticks t{ticks(lower_nm.x, upper_nm.x, subdivisions),
                ticks(lower_nm.y, upper_nm.y, subdivisions),
                ticks(lower_nm.z, upper_nm.z, subdivisions)};
  TriangleMesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_side(mesh, t, axis, false);
    add_side(mesh, t, axis, true);
  }
  return merge_equal_vertices(mesh);
}

TriangleMesh make_sphere(const Vec3& center_nm, double radius_nm, int subdivisions) {
  require_range(subdivisions, 0, 9, "subdivisions");
  require_positive(radius_nm, "radius");
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) mesh = split_sphere(mesh);
  transform(mesh, radius_nm, center_nm);
  return mesh;
}

HeightField make_mesa(const FieldExtent& extent, double height_nm, double top_width_nm,
                      double wall_run_nm) {
  require_positive(height_nm, "height of the mesa");
  require_positive(top_width_nm, "top width of the mesa");
  require_not_negative(wall_run_nm, "wall run of the mesa");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  Grid<double>& z = field.z_nm;
  for (int row = 0; row < z.height(); ++row) {
    for (int column = 0; column < z.width(); ++column) {
      const double distance_nm = std::max(from_middle(column, z.width(), extent.pitch_nm),
                                          from_middle(row, z.height(), extent.pitch_nm));
      z(column, row) = height_nm * ramp(distance_nm, 0.5 * top_width_nm, run_nm);
    }
  }
  return field;
}

HeightField make_trench(const FieldExtent& extent, double depth_nm, double bottom_width_nm,
                        double wall_run_nm) {
  require_positive(depth_nm, "depth of the trench");
  require_positive(bottom_width_nm, "bottom width of the trench");
  require_not_negative(wall_run_nm, "wall run of the trench");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  Grid<double>& z = field.z_nm;
  for (int row = 0; row < z.height(); ++row) {
    for (int column = 0; column < z.width(); ++column) {
      const double distance_nm = from_middle(column, z.width(), extent.pitch_nm);
      z(column, row) = 0.0 - depth_nm * ramp(distance_nm, 0.5 * bottom_width_nm, run_nm);
    }
  }
  return field;
}

HeightField make_rough(const FieldExtent& extent, double rms_nm, double correlation_nm,
                       std::uint64_t seed) {
  require_positive(rms_nm, "rms height");
  require_positive(correlation_nm, "correlation length");
  HeightField field = flat_field(extent);
  const double period_nm = std::min(field.z_nm.width(), field.z_nm.height()) * extent.pitch_nm;
  if (correlation_nm > 0.5 * period_nm) {
    throw UsageError("correlation length",
                     fmt::format("{} nm is more than half of the field's {} nm", correlation_nm,
                                 period_nm),
                     "A periodic surface cannot vary that slowly: enlarge the field");
  }

  std::vector<double>& z = field.z_nm.data();
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = normal_number(seed, i);
  const std::vector<double> weights = kernel(correlation_nm, extent.pitch_nm);
  field.z_nm = smoothed_transpose(smoothed_transpose(field.z_nm, weights), weights);

  std::vector<double>& smooth = field.z_nm.data();
  const double offset = mean(smooth, [](double v) { return v; });
  for (double& v : smooth) v -= offset;
  const double factor = rms_nm / std::sqrt(mean(smooth, [](double v) { return v * v; }));
  for (double& v : smooth) v *= factor;
  return field;
}

}  // namespace surf
