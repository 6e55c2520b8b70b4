// SPDX-License-Identifier: GPL-3.0-or-later
#include "flat_samples.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace surf {

const std::array<Lag, lag_count> lags{{{0, 0},
                                       {1, 0},
                                       {2, 0},
                                       {-2, 1},
                                       {-1, 1},
                                       {0, 1},
                                       {1, 1},
                                       {2, 1},
                                       {-2, 2},
                                       {-1, 2},
                                       {0, 2},
                                       {1, 2},
                                       {2, 2}}};

namespace {

constexpr double significant = 4;
constexpr int least_pixels_per_coefficient = 4;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Calls visit(i, j) for each pair of pixels that are a lag apart.
template <class Visit>
void each_pair(int width, int height, const std::vector<int>& index, const Lag& lag,
               const Visit& visit) {
  for (int y = 0; y + lag.dy < height; ++y)
    for (int x = std::max(0, -lag.dx); x < width - std::max(0, lag.dx); ++x) {
      const int i = index[static_cast<std::size_t>(y * width + x)];
      const int j = index[static_cast<std::size_t>((y + lag.dy) * width + x + lag.dx)];
      if (i >= 0 && j >= 0) visit(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    }
}

/// Orthonormalises monomials over the pixels, in two passes, which are enough.
void orthonormalise(std::vector<std::vector<double>>& columns) {
  std::vector<std::vector<double>> kept;
  for (std::vector<double>& column : columns) {
    const double before = std::sqrt(dot(column, column));
    for (int pass = 0; pass < 2; ++pass)
      for (const std::vector<double>& k : kept) {
        const double share = dot(column, k);
        for (std::size_t i = 0; i < column.size(); ++i) column[i] -= share * k[i];
      }
    const double length = std::sqrt(dot(column, column));
    if (!(length > 1e-9 * before)) continue;  // for example, for a rectangle one pixel wide
    for (double& v : column) v /= length;
    kept.push_back(std::move(column));
  }
  columns = std::move(kept);
}

}  // namespace

const FlatSamples::Basis& FlatSamples::basis_of(const PixelRectangle& r) {
  const int w = r.x1 - r.x0, h = r.y1 - r.y0;
  std::vector<int> index(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), -1);
  int n = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (valid_.includes(r.x0 + x, r.y0 + y)) index[static_cast<std::size_t>(y * w + x)] = n++;
  if (basis_.width == w && basis_.height == h && basis_.index == index) return basis_;
  basis_ = {w, h, std::move(index), {}, static_cast<int>(responses.size())};
  for (int power = 0; power <= degree_; ++power)
    for (int of_y = 0; of_y <= power; ++of_y) {
      std::vector<double> column;
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
          if (basis_.index[static_cast<std::size_t>(y * w + x)] >= 0)
            column.push_back(std::pow(2.0 * x / w - 1, power - of_y) *
                             std::pow(2.0 * y / h - 1, of_y));
      basis_.columns.push_back(std::move(column));
    }
  orthonormalise(basis_.columns);
  responses.push_back(response_of(basis_));
  return basis_;
}

// Let S_k be the symmetric matrix of pairs k apart (half of it for k = 0: the identity), and M = 1
// - Q Q' the projection that removes the polynomial. Noise of variance 1 and correlation r_k has
// E[e' S_h e] = sum over k of r_k tr(S_h M S_k M), with tr = tr(S_h S_k) - 2 tr(Q' S_h S_k Q) +
// tr(Q' S_h Q Q' S_k Q).
LagResponse FlatSamples::response_of(const Basis& b) {
  const std::size_t n = b.columns.empty() ? 0 : b.columns.front().size(), m = b.columns.size();
  std::vector<std::vector<std::vector<double>>> shifted(lag_count);  // S_k q
  LagSums count{};
  for (std::size_t k = 0; k < lag_count; ++k)
    for (const std::vector<double>& q : b.columns) {
      std::vector<double> s(n, 0);
      count[k] = 0;
      if (k == 0) s = q, count[k] = static_cast<double>(n);
      else
        each_pair(b.width, b.height, b.index, lags[k],
                  [&](std::size_t i, std::size_t j) { s[i] += q[j], s[j] += q[i], count[k] += 2; });
      shifted[k].push_back(std::move(s));
    }
  std::vector<Eigen::MatrixXd> inner(lag_count, Eigen::MatrixXd(m, m));  // Q' S_k Q
  for (std::size_t k = 0; k < lag_count; ++k)
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j)
        inner[k](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            dot(b.columns[i], shifted[k][j]);
  LagResponse response{};
  for (std::size_t h = 0; h < lag_count; ++h)
    for (std::size_t k = 0; k < lag_count; ++k) {
      double trace = h == k ? count[k] : 0;
      for (std::size_t i = 0; i < m; ++i) trace -= 2 * dot(shifted[h][i], shifted[k][i]);
      trace += (inner[h] * inner[k]).trace();
      response[h * lag_count + k] = h == 0 ? trace : 0.5 * trace;
    }
  return response;
}

bool FlatSamples::add(const PixelRectangle& r) {
  const Basis& b = basis_of(r);
  FlatSample s;
  s.region = r;
  s.geometry = b.geometry;
  std::vector<double> e;
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x)
      if (valid_.includes(x, y)) e.push_back(values_(x, y)), s.mean += values_(x, y);
  s.pixels = static_cast<std::int64_t>(e.size());
  if (s.pixels < least_pixels_per_coefficient * coefficients() || b.columns.empty()) return false;
  s.mean /= static_cast<double>(s.pixels);
  for (double& v : e) v -= s.mean;
  for (const std::vector<double>& q : b.columns) {
    const double share = dot(e, q);
    for (std::size_t i = 0; i < e.size(); ++i) e[i] -= share * q[i];
  }
  double largest = 0;
  for (const double v : e) {
    s.squares += v * v, s.fourths += v * v * v * v;
    largest = std::max(largest, std::fabs(v));
  }
  // Rounding errors of a constant are no noise.
  if (largest <= 1e-13 * std::fabs(s.mean)) s.squares = s.fourths = 0;
  s.products[0] = s.squares, s.pairs[0] = static_cast<double>(s.pixels);
  for (std::size_t k = 1; k < lag_count; ++k)
    each_pair(b.width, b.height, b.index, lags[k],
              [&](std::size_t i, std::size_t j) { s.products[k] += e[i] * e[j], s.pairs[k] += 1; });
  samples.push_back(s);
  return true;
}

LagSums pooled_correlation(const FlatSamples& flat, const std::vector<double>& variances) {
  Eigen::Matrix<double, lag_count, lag_count> response = decltype(response)::Zero();
  Eigen::Matrix<double, lag_count, 1> products = decltype(products)::Zero();
  LagSums pairs{};
  for (std::size_t i = 0; i < flat.samples.size(); ++i) {
    const FlatSample& s = flat.samples[i];
    if (!(variances[i] > 0)) continue;
    const LagResponse& r = flat.responses[static_cast<std::size_t>(s.geometry)];
    for (std::size_t h = 0; h < lag_count; ++h) {
      products[static_cast<Eigen::Index>(h)] += s.products[h] / variances[i];
      pairs[h] += s.pairs[h];
      for (std::size_t k = 0; k < lag_count; ++k)
        response(static_cast<Eigen::Index>(h), static_cast<Eigen::Index>(k)) +=
            r[h * lag_count + k];
    }
  }
  LagSums correlation{1};
  if (!(pairs[0] > 0)) return correlation;
  // Lags without any pair of pixels stay 0.
  for (std::size_t h = 1; h < lag_count; ++h)
    if (!(pairs[h] > 0)) response(static_cast<Eigen::Index>(h), static_cast<Eigen::Index>(h)) = 1;
  const Eigen::FullPivLU<decltype(response)> solver(response);
  if (!solver.isInvertible()) return correlation;
  const Eigen::Matrix<double, lag_count, 1> x = solver.solve(products);
  if (!(x[0] > 0)) return correlation;
  for (std::size_t h = 1; h < lag_count; ++h) {
    const double r = x[static_cast<Eigen::Index>(h)] / x[0];
    if (std::fabs(r) * std::sqrt(pairs[h]) > significant) correlation[h] = std::clamp(r, -1.0, 1.0);
  }
  return correlation;
}

double variance_of(const FlatSample& s, const LagResponse& response, const LagSums& correlation) {
  double expected = 0;
  for (std::size_t k = 0; k < lag_count; ++k) expected += response[k] * correlation[k];
  // The variance is unknown if the polynomial removes almost all of the noise.
  return s.squares / std::max(expected, 0.05 * static_cast<double>(s.pixels));
}

double slow_share(const FlatSample& s) {
  if (!(s.squares > 0)) return 0;
  double share = 1;
  for (std::size_t k = 1; k < lag_count; ++k) {
    const double weight = (1 - std::abs(lags[k].dx) / 3.0) * (1 - lags[k].dy / 3.0);
    if (s.pairs[k] > 0) share += 2 * weight * s.products[k] / s.pairs[k] * s.pairs[0] / s.squares;
  }
  return share;
}

double sum_of(const LagSums& correlation) {
  double sum = 1;
  for (std::size_t k = 1; k < lag_count; ++k) sum += 2 * correlation[k];
  return sum;
}

double sum_of_squares(const LagSums& correlation) {
  double sum = 1;
  for (std::size_t k = 1; k < lag_count; ++k) sum += 2 * correlation[k] * correlation[k];
  return sum;
}

}  // namespace surf
