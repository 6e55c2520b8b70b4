// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile/simulation_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surf {
namespace {

struct Normal {
  double minus_log = 0;
  Eigen::VectorXd pull;
  Eigen::MatrixXd matrix;
};

Normal normal_of(const SimulationErrors& errors) {
  Normal out{0, Eigen::VectorXd::Zero(errors.numbers()),
             Eigen::MatrixXd::Zero(errors.numbers(), errors.numbers())};
  errors.add_prior(0, out.minus_log, out.pull, out.matrix);
  return out;
}

TEST(SimulationErrors, LooksThatDifferByLittleAreOffByAboutTheSame) {
  SimulationErrors errors(-30, 50, 4);
  const int above = errors.look({0, 0, 0}), left = errors.look({0, 3, 0}),
            right = errors.look({0, -3, 0}), far = errors.look({0, 12, 0}),
            other = errors.look({1, 0, 0});
  EXPECT_EQ(errors.look({0, 3, 0}), left);
  EXPECT_EQ(errors.look({0, 2, 5}), errors.look({0, 2, -5}));  // along the wall both ways are alike
  const double deviations[] = {0.1, 0.2, 0.3, 0.1, 0.4};
  for (const int look : {above, left, right, far, other})
    errors.set_deviation(look, deviations[look]);
  const Eigen::MatrixXd covariance = normal_of(errors).matrix.inverse();
  const auto correlation = [&](int a, int b) {
    const int i = errors.at(a, 2).numbers[0], j = errors.at(b, 2).numbers[0];
    EXPECT_NEAR(covariance(i, i), deviations[a] * deviations[a], 1e-6);
    return covariance(i, j) / (deviations[a] * deviations[b]);
  };
  EXPECT_NEAR(correlation(above, left), 0.99 * std::exp(-0.125), 1e-6);
  EXPECT_NEAR(correlation(left, right), 0.99 * std::exp(-0.5), 1e-6);
  EXPECT_NEAR(correlation(above, far), 0.99 * std::exp(-2), 1e-6);
  EXPECT_NEAR(correlation(above, other), 0, 1e-6);
  const int here = errors.at(left, 2).numbers[0], there = errors.at(left, 2).numbers[1];
  EXPECT_NEAR(covariance(here, there), 0, 1e-9);
}

TEST(SimulationErrors, GroundAndTopAreOffAlikeFromWhereverTheyAreSeen) {
  SimulationErrors errors(-30, 50, 4);
  const int above = errors.look({0, 0, 0}), tilted = errors.look({0, 12, 0});
  const Eigen::MatrixXd covariance = normal_of(errors).matrix.inverse();
  const int i = errors.at(above, 2).numbers[2], j = errors.at(tilted, 2).numbers[2];
  EXPECT_NEAR(covariance(i, j), 0.99 * std::exp(-0.02), 1e-6);
}

TEST(SimulationErrors, ThePriorsGradientIsItsDerivative) {
  SimulationErrors errors(-10, 10, 5);
  errors.look({0, 0, 0}), errors.look({0, 4, 0}), errors.look({1, 0, 2});
  Eigen::VectorXd step(errors.numbers());
  for (Eigen::Index k = 0; k < step.size(); ++k) step(k) = std::sin(1.0 + k);
  errors.move(step, 0);
  const Normal here = normal_of(errors);
  constexpr double small = 1e-4;
  for (int k = 0; k < errors.numbers(); ++k) {
    Eigen::VectorXd by = Eigen::VectorXd::Zero(errors.numbers());
    by(k) = small;
    SimulationErrors more = errors, less = errors;
    more.move(by, 0), less.move(-by, 0);
    EXPECT_NEAR(-here.pull(k),
                (normal_of(more).minus_log - normal_of(less).minus_log) / (2 * small), 1e-5);
  }
}

TEST(SimulationErrors, AShareNarrowsThePriorAndItsDeterminantIsKnown) {
  SimulationErrors errors(-10, 10, 5);
  const int first = errors.look({0, 0, 0}), second = errors.look({0, 4, 0});
  errors.set_deviation(first, 0.2), errors.set_deviation(second, 0.3);
  const Eigen::MatrixXd whole = normal_of(errors).matrix;
  EXPECT_NEAR(errors.log_prior_determinant(), std::log(whole.determinant()), 1e-9);
  errors.set_share(0.25);
  const Eigen::MatrixXd narrow = normal_of(errors).matrix;
  EXPECT_NEAR((narrow - 16 * whole).norm(), 0, 1e-9 * narrow.norm());
  EXPECT_NEAR(errors.log_prior_determinant(), std::log(narrow.determinant()), 1e-9);
}

TEST(SimulationErrors, AreStraightBetweenTheirPlaces) {
  SimulationErrors errors(0, 40, 4);
  const int first = errors.look({0, 0, 0}), second = errors.look({0, 30, 0});
  Eigen::VectorXd step = Eigen::VectorXd::Zero(errors.numbers());
  const int begin = errors.at(second, 8).numbers[0];
  step(begin) = 1, step(begin + 1) = 3;
  errors.move(step, 0);
  EXPECT_NEAR(errors.value(second, 8), 1, 1e-12);
  EXPECT_NEAR(errors.value(second, 11), 2.5, 1e-12);
  EXPECT_NEAR(errors.value(second, -100), 0, 1e-12);
  EXPECT_EQ(errors.value(first, 8), 0);
}

}  // namespace
}  // namespace surf
