// SPDX-License-Identifier: GPL-3.0-or-later
#include "coarse_fits.h"

#include <algorithm>

#include "sem/model/border.h"
#include "surf/core/parallel.h"
#include "transposed_fits.h"

namespace surf::facet {
namespace {

constexpr double least_sigma = 0.84;
constexpr int most_halvings = 6;

FacetScale halved(const FacetScale& scale, int times) {
  const int step = 1 << times, radius = std::max(2, (scale.size / 2 + step - 1) / step);
  return {2 * radius + 1, scale.sigma_px / step};
}

constexpr double smooth[3] = {0.25, 0.5, 0.25};

/// The indices of the samples of a line from one before its first to one behind its last, clamped.
std::vector<int> neighbours(int count) {
  std::vector<int> from;
  for (int i = -1; i <= count; ++i) from.push_back(std::clamp(i, 0, count - 1));
  return from;
}

/// Every other sample, smoothed, minus a level. Index i of a line is sample from[i + 1].
Grid<double> halve(const Grid<double>& z, const std::vector<int>& from_x,
                   const std::vector<int>& from_y, double level) {
  Grid<double> out(static_cast<int>(from_x.size() - 1) / 2,
                   static_cast<int>(from_y.size() - 1) / 2);
  std::vector<double> line(z.width());
  for (int y = 0; y < out.height(); ++y) {
    const double *const a = &z(0, from_y[2 * y]), *const b = &z(0, from_y[2 * y + 1]),
                        *const c = &z(0, from_y[2 * y + 2]);
    for (int x = 0; x < z.width(); ++x)
      line[x] =
          smooth[0] * (a[x] - level) + smooth[1] * (b[x] - level) + smooth[2] * (c[x] - level);
    for (int x = 0; x < out.width(); ++x)
      out(x, y) = smooth[0] * line[from_x[2 * x]] + smooth[1] * line[from_x[2 * x + 1]] +
                  smooth[2] * line[from_x[2 * x + 2]];
  }
  return out;
}

/// The transpose of `halve`: adds to z.
void halve_transposed(const Grid<double>& out, const std::vector<int>& from_x,
                      const std::vector<int>& from_y, Grid<double>& z) {
  std::vector<double> line(z.width());
  for (int y = 0; y < out.height(); ++y) {
    std::fill(line.begin(), line.end(), 0.0);
    for (int x = 0; x < out.width(); ++x)
      for (int k = 0; k < 3; ++k) line[from_x[2 * x + k]] += smooth[k] * out(x, y);
    for (int k = 0; k < 3; ++k) {
      double* const to = &z(0, from_y[2 * y + k]);
      for (int x = 0; x < z.width(); ++x) to[x] += smooth[k] * line[x];
    }
  }
}

}  // namespace

int halvings(const FacetScale& scale) {
  int times = 0;
  while (times < most_halvings && scale.sigma_px / (2 << times) >= least_sigma) ++times;
  return times;
}

template <class T>
CoarseFits<T>::CoarseFits(const std::vector<FacetScale>& scales, double pitch_x_nm,
                          double pitch_y_nm) {
  for (const FacetScale& scale : scales) {
    Fit& fit = fits_.emplace_back();
    fit.level = halvings(scale);
    if (fit.level == 0) continue;
    const int step = 1 << fit.level;
    const FacetScale coarse = halved(scale, fit.level);
    fit.radius = coarse.size / 2;
    fit.pass.emplace_back(std::vector{coarse}, pitch_x_nm * step, pitch_y_nm * step);
    levels_ = std::max(levels_, fit.level);
    // The fit, smoothing and interpolation.
    margin_ = std::max(margin_, (coarse.size / 2 + 3) * step);
  }
  const int whole = 1 << levels_;
  margin_ = (margin_ + whole - 1) / whole * whole;
}

template <class T>
std::vector<int> CoarseFits<T>::continued(int count, Edge edge) const {
  std::vector<int> from;
  for (int i = -margin_ - 1; i <= count + margin_; ++i)
    from.push_back(border_sample(i, count, edge));
  return from;
}

/// The coarse samples from which a line of `count` samples is interpolated, and those that their
/// fits need.
template <class T>
typename CoarseFits<T>::Range CoarseFits<T>::range(const Fit& fit, int count) const {
  const int step = 1 << fit.level, first = margin_ / step - fit.radius;
  return {first, (margin_ + count - 1) / step + 2 + fit.radius - first};
}

template <class T>
void CoarseFits<T>::load(const Grid<double>& z_nm, Edge edge, int threads, const Watch& watch) {
  if (levels_ == 0) return;
  threads = resolve_threads(threads);
  // Relative to a height, because smoothing would round constant heights.
  Grid<double> z =
      halve(z_nm, continued(z_nm.width(), edge), continued(z_nm.height(), edge), z_nm(0, 0));
  for (int level = 1; level <= levels_; ++level) {
    if (level > 1) z = halve(z, neighbours(z.width()), neighbours(z.height()), 0);
    for (Fit& fit : fits_)
      if (fit.level == level) fit_level(z, z_nm.width(), z_nm.height(), threads, watch, fit);
  }
}

template <class T>
void CoarseFits<T>::fit_level(const Grid<double>& z, int width, int height, int threads,
                              const Watch& watch, Fit& fit) const {
  const Range x = range(fit, width), y = range(fit, height);
  Grid<double> part(x.count, y.count);
  for (int row = 0; row < y.count; ++row)
    std::copy_n(&z(x.first, y.first + row), x.count, &part(0, row));
  const FacetPass<T>& pass = fit.pass[0];
  fit.width = x.count;
  fit.planes.resize(coefficients * part.size());
  const std::vector<Block> blocks = pass.blocks(x.count, y.count);
  std::vector<typename FacetPass<T>::Scratch> workers(threads);
  std::vector<Floors<T>> floors(blocks.size());
  parallel_for(
      blocks.size(), threads,
      [&](std::size_t i, int w) {
        const Block& block = blocks[i];
        pass.load(part, Edge::flat, block, workers[w]);
        const T* k = pass.fit(0, workers[w]);
        floors[i] = pass.floors(0, workers[w]);
        for (int row = block.y; row < block.y + block.rows; ++row)
          for (int c = 0; c < coefficients; ++c, k += pass.columns())
            std::copy_n(k, block.width,
                        fit.planes.data() +
                            (static_cast<std::size_t>(row) * coefficients + c) * x.count + block.x);
      },
      watch);
  fit.floors = {};
  for (const Floors<T>& f : floors)
    fit.floors = {std::max(fit.floors.slope, f.slope), std::max(fit.floors.curvature, f.curvature)};
}

/// The interpolation weights of coarse samples for the pixels of a block.
template <class T>
typename CoarseFits<T>::Worth CoarseFits<T>::worth(const Fit& fit, const Block& block,
                                                   int columns) const {
  const int step = 1 << fit.level, first = (block.x + margin_) / step;
  Worth worth;
  worth.first = first - range(fit, 1).first;
  worth.count = (block.x + block.width - 1 + margin_) / step + 2 - first;
  worth.of.assign(static_cast<std::size_t>(worth.count) * columns, T(0));
  for (int x = 0; x < block.width; ++x) {
    const int i = block.x + x + margin_, sample = i / step - first;
    const T fraction = T(i % step) / T(step);
    worth.of[sample * columns + x] = 1 - fraction;
    worth.of[(sample + 1) * columns + x] = fraction;
  }
  return worth;
}

template <class T>
typename CoarseFits<T>::Range CoarseFits<T>::rows_of(const Fit& fit, const Block& block) const {
  const int step = 1 << fit.level, first = (block.y + margin_) / step;
  return {first - range(fit, 1).first, (block.y + block.rows - 1 + margin_) / step + 2 - first};
}

template <class T>
void CoarseFits<T>::at(int scale, const Block& block, int columns, AlignedVector<T>& memory,
                       T* out) const {
  const Fit& fit = fits_[scale];
  const Operations<T>& loops = fit.pass[0].loops();
  const Worth of = worth(fit, block, columns);
  const Range rows = rows_of(fit, block);
  memory.resize(static_cast<std::size_t>(rows.count) * coefficients * columns);
  const T* from = fit.planes.data() +
                  static_cast<std::size_t>(rows.first) * coefficients * fit.width + of.first;
  for (int i = 0; i < rows.count * coefficients; ++i, from += fit.width)
    loops.spread(from, of.count, of.of.data(),
                 memory.data() + static_cast<std::ptrdiff_t>(i) * columns);
  const int step = 1 << fit.level;
  loops.between_rows(memory.data(), (block.y + margin_) % step, step, block.rows, out);
}

template <class T>
void CoarseFits<T>::transpose(const Source& source, int columns, Edge edge, int threads,
                              double unit, Grid<double>& gradient) const {
  if (levels_ == 0) return;
  const int width = gradient.width(), height = gradient.height();
  const std::vector<int> from_x = continued(width, edge), from_y = continued(height, edge);
  std::vector<Grid<double>> levels{{}};
  for (int w = width + 2 * margin_, h = height + 2 * margin_;
       static_cast<int>(levels.size()) <= levels_;) {
    w = (w + 1) / 2;
    h = (h + 1) / 2;
    levels.emplace_back(w, h);
  }
  for (std::size_t s = 0; s < fits_.size(); ++s)
    if (fits_[s].level > 0)
      transpose_fit(static_cast<int>(s), source, columns, threads, unit, width, height,
                    levels[fits_[s].level]);
  for (int level = levels_; level > 1; --level) {
    Grid<double>& finer = levels[level - 1];
    halve_transposed(levels[level], neighbours(finer.width()), neighbours(finer.height()), finer);
  }
  halve_transposed(levels[1], from_x, from_y, gradient);
}

template <class T>
void CoarseFits<T>::transpose_fit(int scale, const Source& source, int columns, int threads,
                                  double unit, int width, int height, Grid<double>& level) const {
  const Fit& fit = fits_[scale];
  const FacetPass<T>& pass = fit.pass[0];
  const Operations<T>& loops = pass.loops();
  const Range x = range(fit, width), y = range(fit, height);
  const int strips = (width + columns - 1) / columns, step = 1 << fit.level;
  const Range rows = rows_of(fit, {0, 0, width, height});
  threads = resolve_threads(threads);
  // Each strip has sums of its own, so that the order of additions does not depend on threads.
  std::vector<AlignedVector<T>> found(strips);
  std::vector<Worth> worths(strips);
  std::vector<AlignedVector<T>> weights(threads), samples(threads);
  parallel_for(strips, threads, [&](std::size_t strip, int w) {
    const int left = static_cast<int>(strip) * columns;
    const Block column{left, 0, std::min(columns, width - left), height};
    weights[w].resize(static_cast<std::size_t>(height) * coefficients * columns);
    source(w, scale, column, weights[w].data());
    samples[w].assign(static_cast<std::size_t>(rows.count) * coefficients * columns, T(0));
    loops.between_rows_transposed(weights[w].data(), margin_ % step, step, height,
                                  samples[w].data());
    const Worth& of = worths[strip] = worth(fit, column, columns);
    found[strip].assign(static_cast<std::size_t>(rows.count) * coefficients * of.count, T(0));
    for (int i = 0; i < rows.count * coefficients; ++i)
      loops.spread_transposed(samples[w].data() + static_cast<std::ptrdiff_t>(i) * columns,
                              of.count, of.of.data(),
                              found[strip].data() + static_cast<std::ptrdiff_t>(i) * of.count);
  });
  Planes coarse(static_cast<std::size_t>(y.count) * coefficients * x.count, T(0));
  for (int strip = 0; strip < strips; ++strip) {
    const T* from = found[strip].data();
    T* to = coarse.data() + static_cast<std::size_t>(rows.first) * coefficients * x.count +
            worths[strip].first;
    for (int i = 0; i < rows.count * coefficients; ++i, to += x.count)
      for (int j = 0; j < worths[strip].count; ++j) to[j] += *from++;
  }
  Grid<double> part(x.count, y.count);
  TransposedFits<T> transposed(pass, Edge::flat, threads);
  transposed.add_all(
      [&](int, int, const Block& block, std::size_t, T* out) {
        const T* from =
            coarse.data() + static_cast<std::size_t>(block.y) * coefficients * x.count + block.x;
        for (int i = 0; i < block.rows * coefficients;
             ++i, out += pass.columns(), from += x.count) {
          std::fill_n(out, pass.columns(), T(0));
          std::copy_n(from, block.width, out);
        }
      },
      unit, part);
  for (int row = 0; row < y.count; ++row)
    for (int i = 0; i < x.count; ++i) level(x.first + i, y.first + row) += part(i, row);
}

template class CoarseFits<float>;
template class CoarseFits<double>;

}  // namespace surf::facet
