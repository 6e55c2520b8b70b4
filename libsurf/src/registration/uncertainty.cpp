// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/uncertainty.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace surf {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr int fewest_blocks = 40;
constexpr double unknown_px = 1e3;  // standard error of an undetermined motion
constexpr int farthest_lag = 24;
constexpr double edge_block_px = 16;  // large enough for one wall of a line, not for both

/// The integral of the residuals' autocorrelation along rows and columns, in samples, up to the lag
/// where it vanishes.
double correlation_length(const BlurLevel& level, const Correlation& correlation,
                          const Eigen::VectorXd& residual) {
  std::map<std::pair<int, int>, double> at;
  int columns = 0, rows = 0;
  for (std::size_t k = 0; k < correlation.size(); ++k) {
    const auto& s = level.samples[correlation.overlap()[k]];
    columns = std::max(columns, s.column / level.stride + 1);
    rows = std::max(rows, s.row / level.stride + 1);
  }
  Grid<double> grid(std::max(1, columns), std::max(1, rows), 0);
  for (std::size_t k = 0; k < correlation.size(); ++k) {
    const auto& s = level.samples[correlation.overlap()[k]];
    grid(s.column / level.stride, s.row / level.stride) = residual[static_cast<Eigen::Index>(k)];
  }
  double longest = 0;
  for (const bool along_x : {true, false}) {
    double zero = 0;
    for (const double v : grid.data()) zero += v * v;
    double length = 0;
    for (int lag = 1; lag <= farthest_lag; ++lag) {
      double sum = 0;
      for (int y = 0; y + (along_x ? 0 : lag) < rows; ++y)
        for (int x = 0; x + (along_x ? lag : 0) < columns; ++x)
          sum += grid(x, y) * grid(x + (along_x ? lag : 0), y + (along_x ? 0 : lag));
      if (!(sum > 0.05 * zero)) break;
      length += sum / zero;
    }
    longest = std::max(longest, length);
  }
  return longest;
}

/// The block of each sample, numbered from 0.
struct Blocks {
  std::vector<std::size_t> of_sample;
  std::size_t count = 0;
  int side = 1;  // samples
};

Blocks blocks_of(const BlurLevel& level, const Correlation& correlation, int wanted_side) {
  Blocks blocks;
  const double n = static_cast<double>(correlation.size());
  const int largest = std::max(1, static_cast<int>(std::sqrt(n / fewest_blocks)));
  blocks.side = std::clamp(wanted_side, 1, largest);
  std::map<std::pair<int, int>, std::size_t> numbers;
  for (const std::size_t i : correlation.overlap()) {
    const auto& s = level.samples[i];
    const std::pair<int, int> block{s.column / level.stride / blocks.side,
                                    s.row / level.stride / blocks.side};
    blocks.of_sample.push_back(numbers.try_emplace(block, numbers.size()).first->second);
  }
  blocks.count = numbers.size();
  return blocks;
}

int side_for(double length) { return static_cast<int>(std::ceil(2 + 6 * length)); }

Blocks blocks_for(const BlurLevel& level, const Correlation& correlation, double length) {
  return blocks_of(level, correlation, side_for(length));
}

/// The variance of a sum of parts whose blocks are independent, corrected for the `spent` degrees
/// of freedom.
Eigen::MatrixXd variance_of(const Blocks& blocks, const Eigen::MatrixXd& parts, double spent) {
  Eigen::MatrixXd sums =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(blocks.count), parts.cols());
  for (Eigen::Index k = 0; k < parts.rows(); ++k)
    sums.row(static_cast<Eigen::Index>(blocks.of_sample[static_cast<std::size_t>(k)])) +=
        parts.row(k);
  const auto count = static_cast<double>(blocks.count);
  return sums.transpose() * sums * (count / std::max(1.0, count - spent));
}

double score_error(const Blocks& blocks, const Correlation& correlation,
                   const Eigen::VectorXd& residual, double r) {
  if (!(r > 0)) return 1;
  Eigen::MatrixXd parts(residual.size(), 1);
  for (Eigen::Index k = 0; k < residual.size(); ++k) {
    const double a = correlation.sem()[static_cast<std::size_t>(k)], b = (a - residual[k]) / r;
    parts(k, 0) = a * b - 0.5 * r * (a * a + b * b);
  }
  return std::sqrt(variance_of(blocks, parts, 1)(0, 0));
}

/// Computes the covariance from the derivative of the sum of pulls by the corners, and from the
/// variance of the sum.
void fill(Uncertainty& u, const Matrix6& h, const Matrix6& pull_variance, const Moments& moments) {
  // Motions of unit root mean square over the overlap are unit vectors of w = L^T c.
  Matrix6 metric = 1e-9 * Matrix6::Identity();
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j)
      for (Eigen::Index axis = 0; axis < 2; ++axis)
        metric(2 * i + axis, 2 * j + axis) +=
            moments[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Matrix6 to_motion = metric.llt().matrixL().transpose();
  const Matrix6 from_motion = to_motion.inverse();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(
      Matrix6(from_motion.transpose() * h * from_motion));
  const Matrix6 axes = from_motion * eigen.eigenvectors();
  const Matrix6 pull = axes.transpose() * pull_variance * axes;
  const Vector6 stiffness = eigen.eigenvalues();
  // A direction whose curvature is negative or within rounding is undetermined.
  const double floor = std::max(1e-9 * stiffness.cwiseAbs().maxCoeff(), 1e-15);
  Matrix6 cov;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j) {
      const bool held = stiffness[i] > floor && stiffness[j] > floor;
      cov(i, j) = held     ? pull(i, j) / (stiffness[i] * stiffness[j])
                  : i == j ? unknown_px * unknown_px
                           : 0;
    }
  const Eigen::SelfAdjointEigenSolver<Matrix6> spread(cov);
  u.loosest_px = std::min(unknown_px, std::sqrt(std::max(0.0, spread.eigenvalues()[5])));
  u.place_px = std::min(unknown_px, std::sqrt(std::max(0.0, cov.trace())));
  for (Eigen::Index k = 0; k < 2; ++k)
    for (Eigen::Index i = 0; i < 6; ++i)
      u.loosest[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] = axes(i, k);
  const Matrix6 of_corners = axes * cov * axes.transpose();
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      u.covariance[static_cast<std::size_t>(6 * i + j)] = of_corners(i, j);
}

/// The variance of the sum of pulls, with each block's pull as if the map had been fitted without
/// that block. Otherwise a block that alone determines a motion, such as the end of a line, would
/// seem to agree with itself.
Matrix6 jackknifed(const Blocks& blocks, const Columns& jacobian, const Eigen::VectorXd& residual) {
  std::vector<Vector6> pulls(blocks.count, Vector6::Zero());
  std::vector<Matrix6> parts(blocks.count, Matrix6::Zero());
  for (Eigen::Index k = 0; k < jacobian.rows(); ++k) {
    const std::size_t b = blocks.of_sample[static_cast<std::size_t>(k)];
    pulls[b] += residual[k] * jacobian.row(k).transpose();
    parts[b].noalias() += jacobian.row(k).transpose() * jacobian.row(k);
  }
  Matrix6 all = Matrix6::Zero(), variance = Matrix6::Zero();
  for (const Matrix6& part : parts) all += part;
  if (!(all.trace() > 0)) return variance;
  all.diagonal().array() += 1e-9 * all.trace();
  const Matrix6 inverse = all.inverse();
  for (std::size_t b = 0; b < blocks.count; ++b) {
    const Matrix6 rest = Matrix6::Identity() - parts[b] * inverse;
    const Vector6 pull = rest.fullPivLu().solve(pulls[b]);
    if (pull.allFinite()) variance += pull * pull.transpose();
  }
  return variance;
}

/// The slopes of the AFM's image, divided by its norm and multiplied by the correlation: a
/// displacement changes the residual by minus these slopes. They are the sums of the Jacobian's
/// columns over the three corners, which then move together.
Eigen::Matrix<double, Eigen::Dynamic, 2> along_axes(const Columns& jacobian) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> g(jacobian.rows(), 2);
  g.col(0) = jacobian.col(0) + jacobian.col(2) + jacobian.col(4);
  g.col(1) = jacobian.col(1) + jacobian.col(3) + jacobian.col(5);
  return g;
}

/// The variance of the sum of pulls if each block is displaced independently, as a whole, by
/// `slip_px` along each axis.
Matrix6 displaced(const Blocks& blocks, const Columns& jacobian, double slip_px) {
  using Couple = Eigen::Matrix<double, 6, 2>;
  const Eigen::Matrix<double, Eigen::Dynamic, 2> g = along_axes(jacobian);
  std::vector<Couple> couples(blocks.count, Couple::Zero());
  for (Eigen::Index k = 0; k < jacobian.rows(); ++k)
    couples[blocks.of_sample[static_cast<std::size_t>(k)]].noalias() +=
        jacobian.row(k).transpose() * g.row(k);
  Matrix6 variance = Matrix6::Zero();
  for (const Couple& c : couples) variance += c * c.transpose();
  return slip_px * slip_px * variance;
}

double own_length(const BlurLevel& level, const ThreePointMap& corners) {
  const Correlation correlation(level, corners);
  Eigen::VectorXd residual(static_cast<Eigen::Index>(correlation.size()));
  if (residual.size() == 0) return 0;
  correlation.evaluate(corners.data(), residual.data(), nullptr);
  return correlation_length(level, correlation, residual);
}

}  // namespace

double independent_share(const BlurLevel& level, const ThreePointMap& corners) {
  return std::pow(1 + 2 * own_length(level, corners), -2);
}

double score_error(const BlurLevel& level, const ThreePointMap& corners) {
  const Correlation correlation(level, corners);
  Eigen::VectorXd residual(static_cast<Eigen::Index>(correlation.size()));
  if (residual.size() == 0) return 1;
  const double r = correlation.evaluate(corners.data(), residual.data(), nullptr);
  const Blocks blocks =
      blocks_for(level, correlation, correlation_length(level, correlation, residual));
  return score_error(blocks, correlation, residual, r);
}

EdgeSlip edge_slip(const BlurLevel& level, const ThreePointMap& corners) {
  const Correlation correlation(level, corners);
  const auto n = static_cast<Eigen::Index>(correlation.size());
  if (n == 0) return {};
  Eigen::VectorXd residual(n);
  Columns jacobian(n, 6);
  correlation.evaluate(corners.data(), residual.data(), jacobian.data());
  const Blocks blocks =
      blocks_of(level, correlation, std::max(1, static_cast<int>(edge_block_px / level.stride)));
  const Eigen::Matrix<double, Eigen::Dynamic, 2> g = along_axes(jacobian);
  std::vector<Eigen::Vector2d> pulls(blocks.count, Eigen::Vector2d::Zero());
  std::vector<Eigen::Matrix2d> stiffness(blocks.count, Eigen::Matrix2d::Zero());
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t b = blocks.of_sample[static_cast<std::size_t>(k)];
    pulls[b] += residual[k] * g.row(k).transpose();
    stiffness[b].noalias() += g.row(k).transpose() * g.row(k);
  }
  double pulled = 0, stiff = 0;
  for (std::size_t b = 0; b < blocks.count; ++b)
    pulled += pulls[b].squaredNorm(), stiff += stiffness[b].squaredNorm();
  EdgeSlip slip;
  if (stiff > 0) slip.px = std::sqrt(pulled / stiff);
  slip.reach_px = side_for(correlation_length(level, correlation, residual)) * level.stride;
  return slip;
}

Uncertainty uncertainty_of(const BlurLevel& level, const ThreePointMap& corners,
                           const EdgeSlip& slip) {
  Uncertainty u;
  const Correlation correlation(level, corners);
  const auto n = static_cast<Eigen::Index>(correlation.size());
  Eigen::VectorXd residual(n);
  Columns jacobian(n, 6);
  const double r =
      n > 0 ? correlation.evaluate(corners.data(), residual.data(), jacobian.data()) : 0;
  const int own_side = n > 0 ? side_for(correlation_length(level, correlation, residual)) : 1;
  const Blocks blocks =
      blocks_of(level, correlation, std::max(own_side, slip.reach_px / level.stride));
  Matrix6 h = Matrix6::Zero();
  if (n > 0) h = Eigen::Map<const Matrix6>(slopes_at(correlation, corners).second.data());
  const Moments moments = moments_of(level, correlation.overlap());
  fill(u, h, jackknifed(blocks, jacobian, residual), moments);
  Uncertainty by_slip;
  fill(by_slip, h, displaced(blocks, jacobian, slip.px), moments);
  if (by_slip.place_px > u.place_px) u = by_slip;
  u.block_px = blocks.side * level.stride;
  u.score = n > 0 ? score_error(blocks, correlation, residual, r) : 1;
  return u;
}

Uncertainty uncertainty_from(const std::array<double, 36>& information, const BlurLevel& level,
                             const ThreePointMap& corners) {
  Uncertainty u;
  const Matrix6 h = Eigen::Map<const Matrix6>(information.data());
  fill(u, h, h, moments_of(level, overlap_of(level, corners)));
  return u;
}

std::array<double, 36> affine_covariance(const ThreePointFrame& frame,
                                         const std::array<double, 36>& corners) {
  const auto numbers = [](const Affine& m) {
    return std::array<double, 6>{m.xx, m.xy, m.x0, m.yx, m.yy, m.y0};
  };
  const std::array<double, 6> at_zero = numbers(frame.affine(ThreePointMap{}));
  Matrix6 by_corner;
  for (std::size_t p = 0; p < 6; ++p) {
    ThreePointMap one{};
    one[p] = 1;
    const std::array<double, 6> at_one = numbers(frame.affine(one));
    for (std::size_t i = 0; i < 6; ++i)
      by_corner(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(p)) =
          at_one[i] - at_zero[i];
  }
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> from(corners.data());
  std::array<double, 36> result{};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(result.data()) =
      by_corner * from * by_corner.transpose();
  return result;
}

}  // namespace surf
