// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace surf {

/// How an image looks at a wall.
struct WallLook {
  int signal = 0;           ///< which signal and energy; of two of them, errors are independent
  double toward_deg = 0;    ///< by how much the beam leans over the wall's material
  double sideways_deg = 0;  ///< and along the wall
};

/// What simulated signals are off by: of each look a function of the distance from the wall, in
/// units of the signal. It has one number at each of some near places and one at each of some far
/// ones. Their prior is normal; of two looks at one place it is correlated as the angle between
/// them is small.
class SimulationErrors {
 public:
  /// Distances from the wall that are asked for, and that between near places, > 0.
  SimulationErrors(double first_nm, double last_nm, double near_nm);

  /// The number of a look, which is added where it is new. At first it is off by nothing.
  int look(const WallLook& look);
  /// The standard deviation of the near and of the far part.
  void set_deviation(int look, double deviation);
  /// What all of them are multiplied by, > 0; at first 1.
  void set_share(double share) { share_ = share; }

  int numbers() const { return static_cast<int>(values_.size()); }
  int near_places() const { return near_; }
  double near_place_nm(int k) const { return first_nm_ + k * near_nm_; }

  /// A value as a sum of numbers: those at near places, and those at far ones.
  struct Sum {
    std::array<int, 4> numbers;
    std::array<double, 4> weights;
  };
  Sum at(int look, double u_nm) const;
  double value(int look, double u_nm) const;
  void move(const Eigen::VectorXd& step, int first);

  /// Adds the prior's part to the normal equations, in which these numbers begin at `first`: minus
  /// the logarithm, minus its gradient, and its second derivatives.
  void add_prior(int first, double& minus_log, Eigen::VectorXd& pull,
                 Eigen::MatrixXd& matrix) const;
  /// The logarithm of the determinant of the prior's second derivatives.
  double log_prior_determinant() const;

 private:
  int places() const { return near_ + far_; }
  /// Of all looks at one place.
  Eigen::MatrixXd covariance(double alike_deg) const;

  double first_nm_, near_nm_, far_nm_;
  int near_, far_;
  double share_ = 1;
  std::vector<WallLook> looks_;
  std::vector<double> deviations_;
  std::vector<double> values_;  // of each look: at near places, then at far ones
};

}  // namespace surf
