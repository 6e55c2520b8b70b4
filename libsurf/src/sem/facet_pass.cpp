// SPDX-License-Identifier: GPL-3.0-or-later
#include "facet_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "border.h"
#include "facet_kernels.h"
#include "surf/core/parallel.h"

namespace surf::facet {
namespace {

// With the widest neighbourhood of the thesis a block of so many rows and its moments stay in the L2 cache.
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
FacetPass<T>::FacetPass(const std::vector<FacetScale>& scales, double pitch_x_nm, double pitch_y_nm, Unit unit)
    : loops_(&operations<T>(unit)) {
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
  for (int x = 0; x < width; x += columns())
    for (int part = 0; part < parts; ++part) {
      const int y = static_cast<int>(std::int64_t{height} * part / parts);
      const int end = static_cast<int>(std::int64_t{height} * (part + 1) / parts);
      blocks.push_back({x, y, std::min(columns(), width - x), end - y});
    }
  return blocks;
}

/// Rows of the field that the block's fits look at, each once, those nearest to the block first, so that a
/// smaller radius needs the first ones only.
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
  s.tile.resize((samples / columns() + 1) * columns());   // whole vectors
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
void FacetPass<T>::load(const Grid<double>& z_nm, Edge edge, const Block& block, Scratch& s, int scale) const {
  s.block = block;
  s.radius = kernels_[scale].radius;
  list_rows(z_nm.height(), edge, s);
  fill_tile(z_nm, edge, s);
}

template <class T>
const T* FacetPass<T>::fit(int scale, Scratch& s) const {
  const Kernel& kernel = kernels_[scale];
  s.moments.resize(s.rows.size() * moments * columns());
  s.coefficients.resize(static_cast<std::size_t>(s.block.rows) * coefficients * columns());
  s.pointers.resize(s.index.size());
  for (std::size_t i = 0; i < s.index.size(); ++i)
    s.pointers[i] = s.moments.data() + static_cast<std::size_t>(s.index[i]) * moments * columns();
  loops_->across(s.tile.data() + s.radius, columns() + 2 * s.radius, s.tile_rows[kernel.radius],
                 kernel.across.data(), kernel.radius, s.moments.data());
  loops_->along(s.pointers.data() + s.radius, s.block.rows, kernel.along.data(), kernel.radius,
                kernel.scaling, s.coefficients.data());
  return s.coefficients.data();
}

template <class T>
Floors<T> FacetPass<T>::floors(int scale, const Scratch& s) const {
  const double rounding = std::numeric_limits<T>::epsilon() *
                          loops_->largest(s.tile.data(), static_cast<std::ptrdiff_t>(s.tile.size()));
  return {T(rounding * kernels_[scale].slope_noise), T(rounding * kernels_[scale].curvature_noise)};
}

template <class T>
void FacetPass<T>::scale_weights(const Scaling<T>& scaling, int height, AlignedVector<T>& weights) const {
  T* row = weights.data();
  for (int y = 0; y < height; ++y, row += coefficients * columns())
    for (int x = 0; x < columns(); ++x) {
      row[3 * columns() + x] *= scaling.k5;
      row[4 * columns() + x] *= scaling.k6;
    }
}

template <class T>
void FacetPass<T>::transpose(Edge edge, int threads, const Source& source, double unit,
                             Grid<double>& gradient) const {
  const int width = gradient.width(), height = gradient.height(), wide = columns();
  const int strips = (width + wide - 1) / wide;
  // Moments of a row, one plane after the other, with zeros to both sides; and the sums of the rows with
  // what falls outside the field, which is folded back at the end.
  const std::ptrdiff_t margin = (2 * radius_ + wide - 1) / wide * wide;   // strips begin at cache lines
  const std::ptrdiff_t plane = std::ptrdiff_t{strips} * wide + 2 * margin + wide;
  const std::ptrdiff_t out_stride = std::ptrdiff_t{strips} * wide + 2 * radius_ + wide;
  AlignedVector<T> planes(static_cast<std::size_t>(height * moments * plane));
  AlignedVector<T> sums(static_cast<std::size_t>(height * out_stride));
  struct Worker {
    AlignedVector<T> weights;
    std::vector<const T*> rows;
    std::vector<T*> out;
  };
  threads = resolve_threads(threads);
  std::vector<Worker> workers(threads);
  const AlignedVector<T> nothing(coefficients * wide);

  for (int scale = 0; scale < scales(); ++scale) {
    const Kernel& kernel = kernels_[scale];
    const int r = kernel.radius;
    parallel_for(strips, threads, [&](std::size_t strip, int w) {
      Worker& worker = workers[w];
      const int x = static_cast<int>(strip) * wide;
      worker.weights.resize(static_cast<std::size_t>(height) * coefficients * wide);
      source(w, scale, {x, 0, std::min(wide, width - x), height}, worker.weights.data());
      scale_weights(kernel.scaling, height, worker.weights);
      worker.rows.assign(height + 4 * r, nothing.data());
      worker.out.resize(height + 2 * r);
      const T** const rows = worker.rows.data() + 2 * r;
      T** const to = worker.out.data() + r;
      for (int y = 0; y < height; ++y)
        rows[y] = worker.weights.data() + static_cast<std::ptrdiff_t>(y) * coefficients * wide;
      for (int y = -r; y < height + r; ++y)
        to[y] = planes.data() + border_sample(y, height, edge) * moments * plane + margin + x;
      loops_->along_transposed(rows, height, kernel.along.data(), 1, r, false, to, plane);
      // Outside the field nothing is nearer than the field.
      for (int out = 1; out <= r; ++out)
        for (const int y : {-out, height - 1 + out})
          loops_->along_transposed(rows + y, 1, kernel.along.data(), out, r, true, to + y, plane);
    });
    const int count = (strips * wide + 2 * r + wide - 1) / wide * wide;
    constexpr int rows_at_once = 8;
    parallel_for((height + rows_at_once - 1) / rows_at_once, threads, [&](std::size_t part, int) {
      const int begin = static_cast<int>(part) * rows_at_once, end = std::min(height, begin + rows_at_once);
      for (int y = begin; y < end; ++y)
        loops_->across_transposed(planes.data() + y * moments * plane + margin - r, plane, count,
                                  kernel.across.data(), r, sums.data() + y * out_stride + radius_ - r);
    });
  }
  for (int y = 0; y < height; ++y)
    for (int x = -radius_; x < width + radius_; ++x)
      gradient(border_sample(x, width, edge), y) += unit * sums[y * out_stride + radius_ + x];
}

template class FacetPass<float>;
template class FacetPass<double>;

}  // namespace surf::facet
