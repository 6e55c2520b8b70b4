// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/correlation.h"

#include <ceres/tiny_solver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace surf {
namespace {

constexpr std::size_t fewest_samples = 24;
constexpr double settled_px = 2e-3;
constexpr double difference_px = 0.05;
// Relative to the largest stiffness; softer motions are not moved.
constexpr double least_stiffness = 1e-6;
constexpr double longest_step_px = 1;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 6>;

double normalise(std::vector<double>& v) {
  double mean = 0, sum = 0;
  for (const double x : v) mean += x;
  mean /= static_cast<double>(v.size());
  for (double& x : v) x -= mean, sum += x * x;
  const double norm = std::sqrt(sum);
  // The rounding errors of an image of one colour are no structure.
  if (!(norm > 1e-12 * (std::abs(mean) + 1e-300) * std::sqrt(static_cast<double>(v.size())))) {
    std::fill(v.begin(), v.end(), 0.0);
    return 0;
  }
  for (double& x : v) x /= norm;
  return norm;
}

/// The interface that the solver requires.
struct Misfit {
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 6 };

  const Correlation& correlation;
  int& evaluations;

  int NumResiduals() const { return static_cast<int>(correlation.size()); }
  bool operator()(const double* corners, double* residuals, double* jacobian) const {
    ++evaluations;
    correlation.evaluate(corners, residuals, jacobian);
    return true;
  }
};

}  // namespace

Correlation::Correlation(const BlurLevel& level, const ThreePointMap& corners)
    : level_(level), overlap_(overlap_of(level, corners)) {
  a_.reserve(overlap_.size());
  for (const std::size_t i : overlap_) a_.push_back(level.samples[i].value);
  if (!a_.empty()) normalise(a_);
}

double Correlation::evaluate(const double* at, double* residuals, double* jacobian) const {
  const std::size_t n = size();
  const ThreePointMap corners{at[0], at[1], at[2], at[3], at[4], at[5]};
  std::vector<double> b(n), dx(jacobian ? n : 0), dy(jacobian ? n : 0);
  for (std::size_t k = 0; k < n; ++k) {
    const Point2 p = place(corners, level_.samples[overlap_[k]].shares);
    const SmoothImage::Value v = level_.afm.at(p.x, p.y);
    b[k] = v.value;
    if (jacobian) dx[k] = v.dx, dy[k] = v.dy;
  }
  const double norm = normalise(b);
  double r = 0;
  for (std::size_t k = 0; k < n; ++k) r += a_[k] * b[k];
  const double rising = std::max(0.0, r);
  for (std::size_t k = 0; k < n; ++k) residuals[k] = a_[k] - rising * b[k];
  if (!jacobian) return r;
  for (std::size_t p = 0; p < 6; ++p) {
    double* const column = jacobian + p * n;
    if (norm == 0 || r <= 0) {
      std::fill_n(column, n, 0.0);
      continue;
    }
    const std::vector<double>& slope = p % 2 == 0 ? dx : dy;
    double mean = 0, along_b = 0;
    for (std::size_t k = 0; k < n; ++k) {
      column[k] = slope[k] * level_.samples[overlap_[k]].shares[p / 2] / norm;
      mean += column[k];
    }
    mean /= static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) {
      column[k] -= mean;
      along_b += column[k] * b[k];
    }
    double along_a = 0;
    for (std::size_t k = 0; k < n; ++k) {
      column[k] -= along_b * b[k];  // derivative of the normalised b
      along_a += column[k] * a_[k];
    }
    for (std::size_t k = 0; k < n; ++k) column[k] = -r * column[k] - along_a * b[k];
  }
  return r;
}

ThreePointMap Correlation::gradient(const ThreePointMap& corners) const {
  const std::size_t n = size();
  std::vector<SmoothImage::Value> v(n);
  double mean = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Point2 p = place(corners, level_.samples[overlap_[k]].shares);
    v[k] = level_.afm.at(p.x, p.y);
    mean += v[k].value;
  }
  mean /= static_cast<double>(n);
  double ab = 0, bb = 0;
  for (std::size_t k = 0; k < n; ++k) {
    v[k].value -= mean;
    ab += a_[k] * v[k].value;
    bb += v[k].value * v[k].value;
  }
  ThreePointMap sum{};
  if (!(ab > 0)) return sum;
  const double slope = ab / bb;
  for (std::size_t k = 0; k < n; ++k) {
    const double left = a_[k] - slope * v[k].value;
    const Shares& shares = level_.samples[overlap_[k]].shares;
    for (std::size_t i = 0; i < 3; ++i) {
      sum[2 * i] -= left * v[k].dx * shares[i];
      sum[2 * i + 1] -= left * v[k].dy * shares[i];
    }
  }
  for (double& g : sum) g *= slope;
  return sum;
}

Slopes slopes_at(const Correlation& correlation, const ThreePointMap& corners) {
  Matrix6 h;
  for (std::size_t p = 0; p < 6; ++p) {
    ThreePointMap above = corners, below = corners;
    above[p] += difference_px;
    below[p] -= difference_px;
    const ThreePointMap up = correlation.gradient(above), down = correlation.gradient(below);
    for (std::size_t i = 0; i < 6; ++i)
      h(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(p)) =
          (up[i] - down[i]) / (2 * difference_px);
  }
  h = (0.5 * (h + h.transpose())).eval();  // symmetric up to rounding
  Slopes slopes{correlation.gradient(corners), {}};
  std::copy_n(h.data(), 36, slopes.second.begin());
  return slopes;
}

namespace {

/// Newton steps. With noise in the AFM's image, the product of slopes is far too stiff along weakly
/// determined motions, and Levenberg and Marquardt's method becomes very slow.
class Newton {
 public:
  /// Makes a step and returns its length in pixels.
  double step(const BlurLevel& level, ThreePointMap& corners, int& evaluations) {
    const Correlation correlation(level, corners);
    if (correlation.size() < fewest_samples) return 0;
    if (!fresh_enough_) {
      const Slopes slopes = slopes_at(correlation, corners);
      eigen_.compute(Matrix6(Eigen::Map<const Matrix6>(slopes.second.data())));
      evaluations += 12;
    }
    const ThreePointMap gradient = correlation.gradient(corners);
    const Vector6 pull =
        eigen_.eigenvectors().transpose() * Eigen::Map<const Vector6>(gradient.data());
    const Vector6& stiffness = eigen_.eigenvalues();
    Vector6 along = Vector6::Zero();
    for (Eigen::Index i = 0; i < 6; ++i)
      if (stiffness[i] > least_stiffness * stiffness[5]) along[i] = -pull[i] / stiffness[i];
    Vector6 step = eigen_.eigenvectors() * along;
    double length = step.cwiseAbs().maxCoeff();
    if (!(length > 0)) return 0;
    if (length > longest_step_px) step *= longest_step_px / length, length = longest_step_px;

    std::vector<double> residual(correlation.size());
    const double here = correlation.evaluate(corners.data(), residual.data(), nullptr);
    evaluations += 2;
    fresh_enough_ = length < 0.25 * longest_step_px;
    for (int half = 0; half < 6;
         ++half, step *= 0.5, length *= 0.5, ++evaluations, fresh_enough_ = false) {
      ThreePointMap next = corners;
      for (std::size_t i = 0; i < 6; ++i) next[i] += step[static_cast<Eigen::Index>(i)];
      if (correlation.evaluate(next.data(), residual.data(), nullptr) < here) continue;
      corners = next;
      return length;
    }
    return 0;
  }

 private:
  Eigen::SelfAdjointEigenSolver<Matrix6> eigen_;
  bool fresh_enough_ = false;  // the last step changed the stiffness little
};

}  // namespace

CorrelationFit fit_correlation(const BlurLevel& level, const ThreePointMap& start, int rounds,
                               int iterations, int newton_steps) {
  CorrelationFit fit;
  fit.corners = start;
  ceres::TinySolver<Misfit> solver;
  solver.options.max_num_iterations = iterations;
  solver.options.function_tolerance = 1e-11;
  solver.options.gradient_tolerance = 1e-11;
  solver.options.parameter_tolerance = 1e-7;
  for (int round = 0; round < rounds && !fit.settled; ++round) {
    const Correlation correlation(level, fit.corners);
    if (correlation.size() < fewest_samples) break;
    const Misfit misfit{correlation, fit.evaluations};
    Eigen::Matrix<double, 6, 1> x =
        Eigen::Map<const Eigen::Matrix<double, 6, 1>>(fit.corners.data());
    solver.Solve(misfit, &x);
    if (!x.allFinite()) break;
    double moved = 0;
    for (Eigen::Index i = 0; i < 6; ++i) {
      moved = std::max(moved, std::abs(x[i] - fit.corners[static_cast<std::size_t>(i)]));
      fit.corners[static_cast<std::size_t>(i)] = x[i];
    }
    fit.settled = moved < settled_px * std::max(1, level.stride);
  }
  Newton newton;
  for (int step = 0; step < newton_steps && (step == 0 || !fit.settled); ++step)
    fit.settled =
        newton.step(level, fit.corners, fit.evaluations) < settled_px * std::max(1, level.stride);
  fit.agreement = agreement_of(level, fit.corners);
  return fit;
}

}  // namespace surf
