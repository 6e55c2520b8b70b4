// SPDX-License-Identifier: GPL-3.0-or-later
#include "distance_grid.h"

#include <algorithm>
#include <array>
#include <limits>

#include "surf/core/parallel.h"

namespace surf::mc {

namespace {

// Positions are good to this: hits lie on triangles up to rounding.
constexpr double slack_nm = 1e-3;

using Corners = std::array<Vec3, 3>;

// Separating axes of a triangle and a box (Akenine-Moeller 2001), with the box grown by the slack
// so that rounding can only mark too many cells.
bool overlaps(const Corners& corners, const Vec3& center, double half) {
  const Vec3 v[3] = {corners[0] - center, corners[1] - center, corners[2] - center};
  auto apart = [&](const Vec3& axis) {
    const double a = dot(v[0], axis), b = dot(v[1], axis), c = dot(v[2], axis);
    const double reach = half * (std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z));
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  if (apart({1, 0, 0}) || apart({0, 1, 0}) || apart({0, 0, 1})) return false;
  const Vec3 edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  if (apart(cross(edges[0], edges[1]))) return false;
  for (const Vec3& e : edges)
    if (apart({0, -e.z, e.y}) || apart({e.z, 0, -e.x}) || apart({-e.y, e.x, 0})) return false;
  return true;
}

struct Lattice {
  int nx, ny, nz;
  Vec3 lower;
  double cell;

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(y)) * static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(x);
  }
};

// Marks the cells in [lo, hi) that the triangle touches, halving the longest side.
void mark(const Lattice& g, const Corners& corners, std::array<int, 3> lo, std::array<int, 3> hi,
          std::vector<std::uint8_t>& marked) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
  const int longest = hi[axis] - lo[axis];
  const Vec3 center = g.lower + Vec3{0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]),
                                     0.5 * (lo[2] + hi[2])} * g.cell;
  // A cube around the block is coarser than the block, but only the last test has to be sharp.
  if (!overlaps(corners, center, 0.5 * longest * g.cell + slack_nm)) return;
  if (longest == 1) {
    marked[g.index(lo[0], lo[1], lo[2])] = 1;
    return;
  }
  auto middle = lo[axis] + longest / 2;
  auto hi_low = hi, lo_high = lo;
  hi_low[axis] = middle;
  lo_high[axis] = middle;
  mark(g, corners, lo, hi_low, marked);
  mark(g, corners, lo_high, hi, marked);
}

void mark_triangles(const Lattice& g, const TriangleMesh& mesh, std::vector<std::uint8_t>& marked) {
  for (const Triangle& t : mesh.triangles) {
    const Corners c{mesh.vertices_nm[t[0]], mesh.vertices_nm[t[1]], mesh.vertices_nm[t[2]]};
    Box box;
    for (const Vec3& v : c) box.extend(v);
    const Vec3 a = (box.lower_nm - g.lower) * (1.0 / g.cell);
    const Vec3 b = (box.upper_nm - g.lower) * (1.0 / g.cell);
    const double s = slack_nm / g.cell;
    auto first = [](double v, int n) { return static_cast<int>(std::clamp(std::floor(v), 0.0, double(n))); };
    const std::array<int, 3> lo{first(a.x - s, g.nx), first(a.y - s, g.ny), first(a.z - s, g.nz)};
    const std::array<int, 3> hi{first(b.x + s + 1, g.nx), first(b.y + s + 1, g.ny),
                                first(b.z + s + 1, g.nz)};
    if (lo[0] < hi[0] && lo[1] < hi[1] && lo[2] < hi[2]) mark(g, c, lo, hi, marked);
  }
}

// Bounds end here: the square still fits beside its neighbours in 16 bits, and an electron that far
// from everything needs no better one.
constexpr int far_cells = 15;
constexpr std::uint16_t far_squared = far_cells * far_cells;

// Squared gap between cells d apart on one axis.
constexpr std::uint16_t gap_squared(int d) {
  return static_cast<std::uint16_t>(d > 1 ? (d - 1) * (d - 1) : 0);
}

// One axis of the squared-gap transform, whole rows at a time:
// out[i] = min over j of in[j] + gap(i - j)^2. Rows of `width` cells lie `stride` apart.
void sweep(std::vector<std::uint16_t>& field, std::size_t start, std::size_t stride, int n,
           std::size_t width, std::vector<std::uint16_t>& copy) {
  copy.resize(static_cast<std::size_t>(n) * width);
  for (int i = 0; i < n; ++i)
    std::copy_n(&field[start + static_cast<std::size_t>(i) * stride], width,
                &copy[static_cast<std::size_t>(i) * width]);
  for (int i = 0; i < n; ++i) {
    std::uint16_t* out = &field[start + static_cast<std::size_t>(i) * stride];
    const int first = std::max(0, i - far_cells), last = std::min(n - 1, i + far_cells);
    for (int j = first; j <= last; ++j) {
      const std::uint16_t g = gap_squared(std::abs(i - j));
      const std::uint16_t* in = &copy[static_cast<std::size_t>(j) * width];
      for (std::size_t x = 0; x < width; ++x) {
        const auto candidate = static_cast<std::uint16_t>(in[x] + g);
        out[x] = candidate < out[x] ? candidate : out[x];
      }
    }
  }
}

// The same along x, where a row holds only 0 and far_squared: two passes count the cells.
void sweep_row(std::uint16_t* row, int n) {
  auto pass = [&](int from, int to, int by) {
    int since = far_cells + 1;
    for (int i = from; i != to; i += by) {
      since = row[i] == 0 ? 0 : std::min(since + 1, far_cells + 1);
      row[i] = std::min(row[i], gap_squared(since));
    }
  };
  // The second pass must not take the first one's small gaps for surface.
  std::vector<std::uint16_t> back(row, row + n);
  pass(0, n, 1);
  std::swap_ranges(back.begin(), back.end(), row);
  pass(n - 1, -1, -1);
  for (int i = 0; i < n; ++i) row[i] = std::min(row[i], back[static_cast<std::size_t>(i)]);
}

}  // namespace

DistanceGrid::DistanceGrid(const TriangleMesh& mesh, const Box& domain, std::size_t bytes)
    : surface_box_(bounds(mesh)) {
  if (mesh.triangles.empty() || bytes < 64 || domain.empty()) return;
  Vec3 size = domain.size_nm();
  const double thickest = std::max({size.x, size.y, size.z, 1e-3});
  size = {std::max(size.x, 1e-3 * thickest), std::max(size.y, 1e-3 * thickest),
          std::max(size.z, 1e-3 * thickest)};
  cell_nm_ = std::max(std::cbrt(size.x * size.y * size.z / static_cast<double>(bytes)), 0.25);
  cells_per_nm_ = 1.0 / cell_nm_;
  quarter_cell_nm_ = 0.25 * cell_nm_ * (1.0 - 1e-9);
  nx_ = static_cast<int>(size.x / cell_nm_) + 1;
  ny_ = static_cast<int>(size.y / cell_nm_) + 1;
  nz_ = static_cast<int>(size.z / cell_nm_) + 1;
  lower_ = domain.lower_nm;
  const Lattice g{nx_, ny_, nz_, lower_, cell_nm_};
  quarters_.assign(g.index(0, 0, nz_), 0);

  std::vector<std::uint8_t>& marked = quarters_;
  mark_triangles(g, mesh, marked);

  // Where triangles lie beyond a side of the domain, that side counts as surface.
  const Vec3 upper = lower_ + Vec3{double(nx_), double(ny_), double(nz_)} * cell_nm_;
  const bool beyond[6] = {surface_box_.lower_nm.x < lower_.x, surface_box_.upper_nm.x > upper.x,
                          surface_box_.lower_nm.y < lower_.y, surface_box_.upper_nm.y > upper.y,
                          surface_box_.lower_nm.z < lower_.z, surface_box_.upper_nm.z > upper.z};
  std::vector<std::uint16_t> squared(quarters_.size(), far_squared);
  for (int z = 0; z < nz_; ++z)
    for (int y = 0; y < ny_; ++y)
      for (int x = 0; x < nx_; ++x) {
        const std::size_t i = g.index(x, y, z);
        if (marked[i] || (beyond[0] && x == 0) || (beyond[1] && x == nx_ - 1) ||
            (beyond[2] && y == 0) || (beyond[3] && y == ny_ - 1) || (beyond[4] && z == 0) ||
            (beyond[5] && z == nz_ - 1))
          squared[i] = 0;
      }

  const std::size_t nx = static_cast<std::size_t>(nx_), ny = static_cast<std::size_t>(ny_);
  const std::size_t nz = static_cast<std::size_t>(nz_);
  const int threads = resolve_threads(0);
  parallel_for(nz, threads, [&](std::size_t z, int) {
    std::vector<std::uint16_t> copy;
    for (std::size_t y = 0; y < ny; ++y) sweep_row(&squared[(z * ny + y) * nx], nx_);
    sweep(squared, z * ny * nx, nx, ny_, nx, copy);
  });
  parallel_for(ny, threads, [&](std::size_t y, int) {
    std::vector<std::uint16_t> copy;
    sweep(squared, y * nx, nx * ny, nz_, nx, copy);
  });
  std::array<std::uint8_t, far_squared + 1> quarters;
  for (std::size_t i = 0; i < quarters.size(); ++i)
    quarters[i] = static_cast<std::uint8_t>(4.0 * std::sqrt(static_cast<double>(i)));
  for (std::size_t i = 0; i < squared.size(); ++i) quarters_[i] = quarters[squared[i]];
}

double DistanceGrid::outside_nm(const Vec3& p) const {
  const double above = p.z - surface_box_.upper_nm.z, below = surface_box_.lower_nm.z - p.z;
  const double dz = std::max({above, below, 0.0});
  const double dx = std::max({surface_box_.lower_nm.x - p.x, p.x - surface_box_.upper_nm.x, 0.0});
  const double dy = std::max({surface_box_.lower_nm.y - p.y, p.y - surface_box_.upper_nm.y, 0.0});
  const double gap = dx == 0 && dy == 0 ? dz : std::sqrt(dx * dx + dy * dy + dz * dz);
  return std::max(0.0, gap - slack_nm);
}

}  // namespace surf::mc
