// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

namespace surf::reconstruction {

/// Levenberg and Marquardt's steps of few unknowns: as long as Gauss and Newton's where these lower
/// the objective.
class DampedSteps {
 public:
  /// Takes the first step that lowers the objective: `take(step)` returns by how much it does, and
  /// moves there if that is above 0. Returns by how much it fell; 0: no step lowers it.
  template <class Take>
  double step(const Eigen::MatrixXd& curvature, const Eigen::VectorXd& gradient, const Take& take) {
    constexpr int most_tries = 8;
    constexpr double least_after_failure = 1e-4;
    for (int tries = 0; tries < most_tries; ++tries) {
      Eigen::MatrixXd damped = curvature;
      damped.diagonal().array() = curvature.diagonal().array() * (1 + damping_) + 1e-12;
      const double fell = take(damped.ldlt().solve(-gradient));
      if (fell > 0) {
        damping_ *= 0.1;
        return fell;
      }
      damping_ = std::max(damping_ * 10, least_after_failure);
    }
    return 0;
  }

 private:
  double damping_ = 1e-6;
};

/// A step that lowers a negative log-likelihood by less is the last.
inline constexpr double settled_step = 0.1;

}  // namespace surf::reconstruction
