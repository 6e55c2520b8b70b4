// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaussian_basis.h"

#include <algorithm>
#include <cmath>

#include "sem/model/border.h"
#include "surf/core/parallel.h"

namespace surf::reconstruction {
namespace {

/// The Gaussian is cut off where it falls below this share of its maximum.
constexpr double faintest = 1e-7;

template <class Work>
void lines(int count, int threads, const Work& work) {
  parallel_for(count, threads, [&](std::size_t i, int) { work(static_cast<int>(i)); });
}

/// A line with mirrored ends. `unload` is the transpose: weights at the ends return to the samples
/// that they came from.
struct Padded {
  std::vector<double> z;
  int reach, count;
  Padded(int beyond, int samples) : z(samples + 2 * beyond), reach(beyond), count(samples) {}
  template <class Get>
  void load(const Get& get) {
    for (int i = -reach; i < count + reach; ++i)
      z[i + reach] = get(border_sample(i, count, Edge::mirror));
  }
  template <class Give>
  void unload(const Give& give) const {
    for (int i = -reach; i < count + reach; ++i)
      if (z[i + reach] != 0) give(border_sample(i, count, Edge::mirror), z[i + reach]);
  }
};

void convolve(const std::vector<double>& half, const Padded& in, std::vector<double>& out) {
  const int reach = in.reach;
  out.assign(in.count, 0);
  for (int k = -reach; k <= reach; ++k) {
    const double w = half[std::abs(k)], *from = in.z.data() + reach + k;
    for (int i = 0; i < in.count; ++i) out[i] += w * from[i];
  }
}

void scatter(const std::vector<double>& half, const std::vector<double>& in, Padded& out) {
  std::fill(out.z.begin(), out.z.end(), 0);
  for (int k = -out.reach; k <= out.reach; ++k) {
    const double w = half[std::abs(k)];
    double* to = out.z.data() + out.reach + k;
    for (int i = 0; i < out.count; ++i) to[i] += w * in[i];
  }
}

}  // namespace

GaussianBasis::GaussianBasis(double sigma_px, int threads) : threads_(threads) {
  const double f = -0.5 / (sigma_px * sigma_px);
  double total = 0;
  for (int i = 0; i == 0 || std::exp(f * i * i) > faintest; ++i) {
    half_.push_back(std::exp(f * i * i));
    total += i == 0 ? half_[0] : 2 * half_[i];
  }
  for (double& w : half_) w /= total;
}

Grid<double> GaussianBasis::sum(const Grid<double>& c) const {
  const int w = c.width(), h = c.height(), reach = static_cast<int>(half_.size()) - 1;
  Grid<double> half(w, h), out(w, h);
  lines(h, threads_, [&](int y) {
    Padded line(reach, w);
    line.load([&](int x) { return c(x, y); });
    std::vector<double> made;
    convolve(half_, line, made);
    std::copy(made.begin(), made.end(), &half(0, y));
  });
  lines(w, threads_, [&](int x) {
    Padded line(reach, h);
    line.load([&](int y) { return half(x, y); });
    std::vector<double> made;
    convolve(half_, line, made);
    for (int y = 0; y < h; ++y) out(x, y) = made[y];
  });
  return out;
}

Grid<double> GaussianBasis::transpose(const Grid<double>& weights) const {
  const int w = weights.width(), h = weights.height(), reach = static_cast<int>(half_.size()) - 1;
  Grid<double> half(w, h), out(w, h);
  lines(w, threads_, [&](int x) {
    std::vector<double> in(h);
    for (int y = 0; y < h; ++y) in[y] = weights(x, y);
    Padded line(reach, h);
    scatter(half_, in, line);
    line.unload([&](int y, double v) { half(x, y) += v; });
  });
  lines(h, threads_, [&](int y) {
    const std::vector<double> in(&half(0, y), &half(0, y) + w);
    Padded line(reach, w);
    scatter(half_, in, line);
    line.unload([&](int x, double v) { out(x, y) += v; });
  });
  return out;
}

Grid<double> GaussianBasis::deconvolved(const Grid<double>& heights, double tolerance,
                                        int iterations, double relaxation) const {
  Grid<double> c = heights;
  for (int i = 0; i < iterations; ++i) {
    const Grid<double> made = sum(c);
    double most = 0;
    for (std::size_t k = 0; k < c.size(); ++k) {
      const double left = heights.data()[k] - made.data()[k];
      most = std::max(most, std::fabs(left));
      c.data()[k] += relaxation * left;
    }
    if (most < tolerance) break;
  }
  return c;
}

}  // namespace surf::reconstruction
