// SPDX-License-Identifier: GPL-3.0-or-later
#include "coarse_fits.h"

#include <algorithm>

#include "border.h"
#include "surf/core/parallel.h"

namespace surf::facet {
namespace {

constexpr double least_sigma = 0.84;
constexpr int most_halvings = 6;

FacetScale halved(const FacetScale& scale, int times) {
  const int step = 1 << times, radius = std::max(2, (scale.size / 2 + step - 1) / step);
  return {2 * radius + 1, scale.sigma_px / step};
}

constexpr double smooth[3] = {0.25, 0.5, 0.25};

/// Every other sample, smoothed; along x, then along y.
Grid<double> halve(const Grid<double>& z) {
  const int width = z.width(), height = z.height();
  Grid<double> rows((width + 1) / 2, height), out((width + 1) / 2, (height + 1) / 2);
  for (int y = 0; y < height; ++y) {
    const double* const from = &z(0, y);
    double* const to = &rows(0, y);
    for (int x = 0; x < rows.width(); ++x)
      to[x] = smooth[0] * from[std::max(2 * x - 1, 0)] + smooth[1] * from[2 * x] +
              smooth[2] * from[std::min(2 * x + 1, width - 1)];
  }
  for (int y = 0; y < out.height(); ++y)
    for (int k = -1; k <= 1; ++k) {
      const int from = std::clamp(2 * y + k, 0, height - 1);
      for (int x = 0; x < out.width(); ++x) out(x, y) += smooth[k + 1] * rows(x, from);
    }
  return out;
}

/// The transpose: adds to z.
void halve_transposed(const Grid<double>& out, Grid<double>& z) {
  const int width = z.width(), height = z.height();
  Grid<double> rows(out.width(), height);
  for (int y = 0; y < out.height(); ++y)
    for (int k = -1; k <= 1; ++k) {
      const int to = std::clamp(2 * y + k, 0, height - 1);
      for (int x = 0; x < out.width(); ++x) rows(x, to) += smooth[k + 1] * out(x, y);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < rows.width(); ++x)
      for (int k = -1; k <= 1; ++k) z(std::clamp(2 * x + k, 0, width - 1), y) += smooth[k + 1] * rows(x, y);
}

}  // namespace

int halvings(const FacetScale& scale) {
  int times = 0;
  while (times < most_halvings && scale.sigma_px / (2 << times) >= least_sigma) ++times;
  return times;
}

template <class T>
CoarseFits<T>::CoarseFits(const std::vector<FacetScale>& scales, double pitch_x_nm, double pitch_y_nm) {
  for (const FacetScale& scale : scales) {
    Fit& fit = fits_.emplace_back();
    fit.level = halvings(scale);
    if (fit.level == 0) continue;
    const int step = 1 << fit.level;
    const FacetScale coarse = halved(scale, fit.level);
    fit.pass.emplace_back(std::vector{coarse}, pitch_x_nm * step, pitch_y_nm * step);
    levels_ = std::max(levels_, fit.level);
    margin_ = std::max(margin_, (coarse.size / 2 + 3) * step);   // the fit, smoothing and interpolation
  }
  const int whole = 1 << levels_;
  margin_ = (margin_ + whole - 1) / whole * whole;
}

template <class T>
typename CoarseFits<T>::Between CoarseFits<T>::between(int pixel, int level) const {
  const int step = 1 << level, i = pixel + margin_;
  return {i / step, T(i % step) / T(step)};
}

template <class T>
void CoarseFits<T>::load(const Grid<double>& z_nm, Edge edge, int threads) {
  if (levels_ == 0) return;
  const int width = z_nm.width(), height = z_nm.height();
  Grid<double> z(width + 2 * margin_, height + 2 * margin_);
  for (int y = 0; y < z.height(); ++y) {
    const int row = border_sample(y - margin_, height, edge);
    for (int x = 0; x < z.width(); ++x)   // relative to a height: smoothing would round what is constant
      z(x, y) = z_nm(border_sample(x - margin_, width, edge), row) - z_nm(0, 0);
  }
  widths_ = {z.width()};
  heights_ = {z.height()};
  threads = resolve_threads(threads);
  for (int level = 1; level <= levels_; ++level) {
    z = halve(z);
    widths_.push_back(z.width());
    heights_.push_back(z.height());
    for (Fit& fit : fits_) {
      if (fit.level != level) continue;
      const FacetPass<T>& pass = fit.pass[0];
      const std::size_t size = z.size();
      fit.planes.assign(coefficients * size, T(0));
      const std::vector<Block> blocks = pass.blocks(z.width(), z.height());
      std::vector<typename FacetPass<T>::Scratch> workers(threads);
      std::vector<Floors<T>> floors(blocks.size());
      parallel_for(blocks.size(), threads, [&](std::size_t i, int w) {
        const Block& block = blocks[i];
        pass.load(z, Edge::flat, block, workers[w]);
        const T* k = pass.fit(0, workers[w]);
        floors[i] = pass.floors(0, workers[w]);
        for (int y = 0; y < block.rows; ++y)
          for (int c = 0; c < coefficients; ++c, k += pass.columns())
            std::copy_n(k, block.width,
                        fit.planes.data() + c * size + static_cast<std::size_t>(block.y + y) * z.width() + block.x);
      });
      fit.floors = {};
      for (const Floors<T>& f : floors)
        fit.floors = {std::max(fit.floors.slope, f.slope), std::max(fit.floors.curvature, f.curvature)};
    }
  }
}

template <class T>
void CoarseFits<T>::at(int scale, const Block& block, int columns, T* out) const {
  const Fit& fit = fits_[scale];
  const std::size_t width = widths_[fit.level], size = width * heights_[fit.level];
  // What each coarse sample is worth to each column: sums of whole rows, which vectors can do.
  const int first = between(block.x, fit.level).sample;
  const int count = between(block.x + block.width - 1, fit.level).sample + 2 - first;
  std::vector<T> worth(static_cast<std::size_t>(count) * columns);
  for (int x = 0; x < block.width; ++x) {
    const Between u = between(block.x + x, fit.level);
    worth[(u.sample - first) * columns + x] = 1 - u.fraction;
    worth[(u.sample + 1 - first) * columns + x] = u.fraction;
  }
  std::fill_n(out, static_cast<std::size_t>(block.rows) * coefficients * columns, T(0));
  for (int y = 0; y < block.rows; ++y) {
    const Between v = between(block.y + y, fit.level);
    for (int c = 0; c < coefficients; ++c, out += columns) {
      const T* const low = fit.planes.data() + c * size + v.sample * width + first;
      for (int i = 0; i < count; ++i) {
        const T sample = low[i] + v.fraction * (low[width + i] - low[i]);
        const T* const w = worth.data() + i * columns;
        for (int x = 0; x < columns; ++x) out[x] += sample * w[x];
      }
    }
  }
}

template <class T>
void CoarseFits<T>::transpose(std::vector<Planes>& weights, Edge edge, int threads, double unit,
                              Grid<double>& gradient) const {
  if (levels_ == 0) return;
  const int width = gradient.width(), height = gradient.height();
  std::vector<Grid<double>> levels;
  for (int level = 0; level <= levels_; ++level) levels.emplace_back(widths_[level], heights_[level]);
  for (std::size_t s = 0; s < fits_.size(); ++s) {
    const Fit& fit = fits_[s];
    if (fit.level == 0 || weights[s].empty()) continue;
    const int coarse_width = widths_[fit.level], coarse_height = heights_[fit.level];
    const std::size_t size = static_cast<std::size_t>(coarse_width) * coarse_height;
    Planes coarse(coefficients * size, T(0));
    // Each plane by itself, so that the order of the sums does not depend on threads.
    parallel_for(coefficients, threads, [&](std::size_t c, int) {
      const T* from = weights[s].data() + c * static_cast<std::size_t>(width) * height;
      std::vector<T> row(coarse_width);
      for (int y = 0; y < height; ++y, from += width) {
        std::fill(row.begin(), row.end(), T(0));
        for (int x = 0; x < width; ++x) {
          const Between u = between(x, fit.level);
          row[u.sample] += (1 - u.fraction) * from[x];
          row[u.sample + 1] += u.fraction * from[x];
        }
        const Between v = between(y, fit.level);
        T* const low = coarse.data() + c * size + static_cast<std::size_t>(v.sample) * coarse_width;
        for (int x = 0; x < coarse_width; ++x) {
          low[x] += (1 - v.fraction) * row[x];
          low[coarse_width + x] += v.fraction * row[x];
        }
      }
    });
    const FacetPass<T>& pass = fit.pass[0];
    pass.transpose(Edge::flat, threads, [&](int, int, const Block& column, T* out) {
      for (int y = 0; y < column.rows; ++y)
        for (int c = 0; c < coefficients; ++c, out += pass.columns()) {
          std::fill_n(out, pass.columns(), T(0));
          std::copy_n(coarse.data() + c * size + static_cast<std::size_t>(y) * coarse_width + column.x, column.width,
                      out);
        }
    }, unit, levels[fit.level]);
  }
  for (int level = levels_; level > 0; --level) halve_transposed(levels[level], levels[level - 1]);
  for (int y = 0; y < levels[0].height(); ++y) {
    const int row = border_sample(y - margin_, height, edge);
    for (int x = 0; x < levels[0].width(); ++x)
      gradient(border_sample(x - margin_, width, edge), row) += levels[0](x, y);
  }
}

template class CoarseFits<float>;
template class CoarseFits<double>;

}  // namespace surf::facet
