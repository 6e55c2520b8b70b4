// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_regression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gaussian_window.h"
#include "surf/core/parallel.h"

namespace surf::guided {
namespace {

constexpr int most_terms = 16;
// A guide whose variance within the window is this share of that over the image has half its slope.
constexpr double prior_share = 0.01;

using Vector = std::array<double, most_terms>;

/// Solves a symmetric positive definite system of `n` equations, stored in rows of `n`, by
/// Cholesky's method. Returns false where it is not definite. `a` is overwritten.
bool solve(int n, double* a, const Vector& right, Vector& x) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (int k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j) {
        if (!(sum > 0)) return false;
        a[i * n + i] = std::sqrt(sum);
      } else {
        a[i * n + j] = sum / a[j * n + j];
      }
    }
  for (int i = 0; i < n; ++i) {
    double sum = right[i];
    for (int k = 0; k < i; ++k) sum -= a[i * n + k] * x[k];
    x[i] = sum / a[i * n + i];
  }
  for (int i = n - 1; i >= 0; --i) {
    double sum = x[i];
    for (int k = i + 1; k < n; ++k) sum -= a[k * n + i] * x[k];
    x[i] = sum / a[i * n + i];
  }
  return true;
}

/// Weighted sums of products of terms: the constant 1, then the guides.
class Moments {
 public:
  Moments(const LocalData& data, const GaussianWindow& window, const GaussianWindow& squared,
          int threads)
      : terms_(static_cast<int>(data.guides.size()) + 1),
        // Weights squared are this times the squared window's.
        squared_sum_(window.middle() * window.middle() / squared.middle()) {
    const std::size_t pairs = static_cast<std::size_t>(terms_ * (terms_ + 1) / 2);
    products_.resize(pairs);
    squared_.resize(pairs);
    targets_.resize(static_cast<std::size_t>(terms_));
    std::vector<std::vector<double>> scratch(static_cast<std::size_t>(resolve_threads(threads)));
    parallel_for(pairs + targets_.size(), threads, [&](std::size_t unit, int worker) {
      std::vector<double>& own = scratch[static_cast<std::size_t>(worker)];
      if (unit >= pairs) {
        std::vector<double>& plane = targets_[unit - pairs];
        plane = weighted(data, static_cast<int>(unit - pairs), 0);
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] *= data.target[i];
        window.sum(plane, data.width, data.height, own);
        return;
      }
      int a = 0;
      while ((a + 1) * (a + 2) / 2 <= static_cast<int>(unit)) ++a;
      products_[unit] = weighted(data, a, static_cast<int>(unit) - a * (a + 1) / 2);
      squared_[unit] = products_[unit];
      window.sum(products_[unit], data.width, data.height, own);
      squared.sum(squared_[unit], data.width, data.height, own);
    });
  }

  double product(int a, int b, std::size_t i) const { return products_[pair(a, b)][i]; }
  double target(int a, std::size_t i) const { return targets_[static_cast<std::size_t>(a)][i]; }
  double squared(int a, int b, std::size_t i) const {
    return squared_sum_ * squared_[pair(a, b)][i];
  }

 private:
  static std::size_t pair(int a, int b) {
    return static_cast<std::size_t>(a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a);
  }
  static std::vector<double> weighted(const LocalData& data, int a, int b) {
    std::vector<double> plane = data.precision;
    for (const int term : {a, b})
      if (term > 0)
        for (std::size_t i = 0; i < plane.size(); ++i)
          plane[i] *= data.guides[static_cast<std::size_t>(term - 1)][i];
    return plane;
  }

  int terms_;
  double squared_sum_;
  std::vector<std::vector<double>> products_, squared_, targets_;
};

}  // namespace

std::vector<LocalFit> fit_locally(const LocalData& data, double sigma_px, const PixelRange& wanted,
                                  std::span<const std::vector<int>> sets, int threads) {
  const GaussianWindow window(sigma_px);
  const Moments moments(data, window, GaussianWindow(sigma_px / std::numbers::sqrt2), threads);
  std::vector<LocalFit> fits(sets.size());
  for (LocalFit& fit : fits) {
    fit.value.assign(data.size(), 0.0);
    fit.variance.assign(data.size(), 0.0);
    fit.leverage.assign(data.size(), 0.0);
  }
  parallel_for(static_cast<std::size_t>(wanted.height()), threads, [&](std::size_t unit, int) {
    std::array<int, most_terms> term{};
    std::array<double, static_cast<std::size_t>(most_terms) * most_terms> system;
    Vector at, weights;
    const std::size_t row =
        (static_cast<std::size_t>(wanted.y0) + unit) * static_cast<std::size_t>(data.width);
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const int n = static_cast<int>(sets[s].size()) + 1;
      for (int a = 1; a < n; ++a) term[a] = sets[s][static_cast<std::size_t>(a - 1)] + 1;
      for (std::size_t i = row + static_cast<std::size_t>(wanted.x0);
           i < row + static_cast<std::size_t>(wanted.x1); ++i) {
        const double total = moments.product(0, 0, i);
        if (!(total > 0)) continue;
        at[0] = 1;
        for (int a = 1; a < n; ++a) at[a] = data.guides[static_cast<std::size_t>(term[a] - 1)][i];
        for (int a = 0; a < n; ++a)
          for (int b = 0; b <= a; ++b)
            system[static_cast<std::size_t>(a * n + b)] =
                moments.product(term[a], term[b], i) + (a == b && a > 0 ? prior_share * total : 0);
        if (!solve(n, system.data(), at, weights)) continue;
        double value = 0, variance = 0, leverage = 0;
        for (int a = 0; a < n; ++a) {
          value += weights[a] * moments.target(term[a], i);
          leverage += weights[a] * at[a];
          for (int b = 0; b < n; ++b)
            variance += weights[a] * weights[b] * moments.squared(term[a], term[b], i);
        }
        fits[s].value[i] = value;
        fits[s].variance[i] = std::max(variance, 0.0);
        fits[s].leverage[i] = window.middle() * data.precision[i] * leverage;
      }
    }
  });
  return fits;
}

}  // namespace surf::guided
