// SPDX-License-Identifier: GPL-3.0-or-later
#include "facet_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "facet_kernels.h"
#include "sem/model/border.h"

namespace surf::facet {
namespace {

// A block of this many rows and its moments stay in the L2 cache, with the widest neighbourhood of
// the thesis.
constexpr int most_rows = 320;

double sum_of_magnitudes(const std::vector<double>& factors) {
  double sum = std::abs(factors[0]);
  for (std::size_t u = 1; u < factors.size(); ++u) sum += 2 * std::abs(factors[u]);
  return sum;
}

double slope_noise(const FacetKernel& a, const FacetKernel& b) {
  return sum_of_magnitudes(a.o3) + b.mix * sum_of_magnitudes(a.o1) * sum_of_magnitudes(b.e2);
}

}  // namespace

template <class T>
FacetPass<T>::FacetPass(const std::vector<FacetScale>& scales, double pitch_x_nm, double pitch_y_nm)
    : loops_(&operations<T>()) {
  for (const FacetScale& scale : scales) {
    const FacetKernel x = facet_kernel(scale, pitch_x_nm), y = facet_kernel(scale, pitch_y_nm);
    Kernel& kernel = kernels_.emplace_back();
    kernel.radius = x.radius;
    kernel.scaling = {T(-1 / y.mix), T(-1 / x.mix)};
    kernel.slope_noise = slope_noise(x, y) + slope_noise(y, x);
    kernel.curvature_noise = sum_of_magnitudes(x.e2) + sum_of_magnitudes(y.e2) +
                             sum_of_magnitudes(x.o1) * sum_of_magnitudes(y.o1);
    radius_ = std::max(radius_, x.radius);
    for (int u = 0; u <= x.radius; ++u) {
      kernel.across.push_back({T(x.e0[u]), T(-y.mix * x.o1[u]), T(-x.mix * x.e2[u]), T(x.o3[u])});
      kernel.along.push_back({T(y.e0[u]), T(y.o1[u]), T(y.e2[u]), T(y.o3[u])});
    }
  }
}

template <class T>
std::vector<Block> FacetPass<T>::blocks(int width, int height) const {
  const int parts = (height + most_rows - 1) / most_rows;
  std::vector<Block> blocks;
  for (int part = 0; part < parts; ++part) {
    const int y = static_cast<int>(std::int64_t{height} * part / parts);
    const int end = static_cast<int>(std::int64_t{height} * (part + 1) / parts);
    for (int x = 0; x < width; x += columns())
      blocks.push_back({x, y, std::min(columns(), width - x), end - y});
  }
  return blocks;
}

/// Lists the rows of the field that the block's fits need, each once, those nearest to the block
/// first, so that a smaller radius needs only the first ones.
template <class T>
void FacetPass<T>::list_rows(int height, Edge edge, Scratch& s) const {
  const Block& block = s.block;
  s.rows.clear();
  s.tile_rows.assign(s.radius + 1, block.rows);
  s.index.resize(block.rows + 2 * s.radius);
  for (int y = 0; y < block.rows; ++y) {
    s.rows.push_back(block.y + y);
    s.index[s.radius + y] = y;
  }
  for (int r = 1; r <= s.radius; ++r) {
    for (const int y : {block.y - r, block.y + block.rows - 1 + r}) {
      const int row = border_sample(y, height, edge);
      int at = row - block.y;
      if (at < 0 || at >= block.rows) {
        const auto known = std::find(s.rows.begin() + block.rows, s.rows.end(), row);
        at = static_cast<int>(known - s.rows.begin());
        if (known == s.rows.end()) s.rows.push_back(row);
      }
      s.index[y - block.y + s.radius] = at;
    }
    s.tile_rows[r] = static_cast<int>(s.rows.size());
  }
}

template <class T>
void FacetPass<T>::fill_tile(const Grid<double>& z_nm, Edge edge, Scratch& s) const {
  const int width = z_nm.width(), stride = columns() + 2 * s.radius;
  const std::size_t samples = s.rows.size() * static_cast<std::size_t>(stride);
  s.tile.resize((samples / columns() + 1) * columns());  // whole vectors
  std::fill(s.tile.begin() + static_cast<std::ptrdiff_t>(samples), s.tile.end(), T(0));
  const double level = z_nm(s.block.x + s.block.width / 2, s.block.y + s.block.rows / 2);
  const int first = s.block.x - s.radius;
  const int begin = std::clamp(-first, 0, stride), end = std::clamp(width - first, begin, stride);
  for (std::size_t i = 0; i < s.rows.size(); ++i) {
    T* const out = s.tile.data() + i * stride;
    const double* const z = &z_nm(0, s.rows[i]);
    for (int x = 0; x < begin; ++x) out[x] = T(z[border_sample(first + x, width, edge)] - level);
    loops_->relative(z + first + begin, end - begin, level, out + begin);
    for (int x = end; x < stride; ++x) out[x] = T(z[border_sample(first + x, width, edge)] - level);
  }
}

template <class T>
void FacetPass<T>::load(const Grid<double>& z_nm, Edge edge, const Block& block, Scratch& s) const {
  s.block = block;
  s.radius = radius_;
  list_rows(z_nm.height(), edge, s);
  fill_tile(z_nm, edge, s);
}

template <class T>
void FacetPass<T>::load(const Grid<double>& z_nm, Edge edge, const Block& block, Scratch& s,
                        int scale) const {
  s.block = block;
  s.radius = kernels_[scale].radius;
  list_rows(z_nm.height(), edge, s);
  fill_tile(z_nm, edge, s);
}

template <class T>
const T* FacetPass<T>::fit(int scale, Scratch& s) const {
  const Kernel& kernel = kernels_[scale];
  const int rows = s.block.rows, r = kernel.radius, stride = columns() + 2 * s.radius;
  const std::size_t row_size = static_cast<std::size_t>(moments) * columns();
  s.coefficients.resize(static_cast<std::size_t>(rows + 1) * coefficients * columns());
  // The rows in their order, one more for the last pair, and the rows outside the block as listed.
  s.moments.resize((rows + 2 * r + 1 + s.tile_rows[r] - rows) * row_size);
  T* const inside = s.moments.data() + r * row_size;
  T* const outside = inside + (rows + r + 1) * row_size;
  const T* const tile = s.tile.data() + s.radius;
  loops_->across(tile, stride, rows, kernel.across.data(), r, inside);
  loops_->across(tile + static_cast<std::ptrdiff_t>(rows) * stride, stride, s.tile_rows[r] - rows,
                 kernel.across.data(), r, outside);
  for (int out = 1; out <= r; ++out)
    for (const int y : {-out, rows - 1 + out}) {
      const int at = s.index[s.radius + y];
      std::copy_n(at < rows ? inside + at * row_size : outside + (at - rows) * row_size, row_size,
                  inside + y * static_cast<std::ptrdiff_t>(row_size));
    }
  loops_->along(inside, rows, kernel.along.data(), r, kernel.scaling, s.coefficients.data());
  return s.coefficients.data();
}

template <class T>
Floors<T> FacetPass<T>::floors(int scale, const Scratch& s) const {
  const double rounding =
      std::numeric_limits<T>::epsilon() *
      loops_->largest(s.tile.data(), static_cast<std::ptrdiff_t>(s.tile.size()));
  return {T(rounding * kernels_[scale].slope_noise), T(rounding * kernels_[scale].curvature_noise)};
}

template class FacetPass<float>;
template class FacetPass<double>;

}  // namespace surf::facet
