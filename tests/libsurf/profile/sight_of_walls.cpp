// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile/sight_of_walls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "profile/library_of.h"

namespace surf {
namespace {

const ProfileBox box{{80, 100, 86, 4, 3}, {6, 20, 2, 0, 0}};

/// A bright rim, wider on shallow walls and brighter on wide features, before a shadow.
double signal(double u, const ProfileNumbers& n) {
  const double rim = std::exp(-0.5 * std::pow((u - 2) / (4 + 0.5 * (90 - n[profile_angle])), 2)),
               shadow = std::exp(-0.5 * std::pow((u + 9) / 5, 2));
  return 0.8 + 0.1 * std::erf(u / 5) + (1.2 + 0.02 * (n[profile_width] - 80)) * rim -
         0.0015 * n[profile_height] * shadow;
}

ProfileLibrary library() { return test::library_of(box, -35, 35, signal); }

/// A line between two walls, seen at a tilt; places lie between the library's.
ProfileSight sight(const ProfileLibrary& walls) {
  ProfileSight s;
  s.left = s.right = &walls;
  s.tilt_deg = 8, s.tilt_error_deg = 0.5;
  s.data.rows = 4;
  const ProfileNumbers n{82, 95, 86.4, 4, 3};
  for (int e = 0; e < 2; ++e) {
    ImageEdge edge;
    edge.material_right = e == 0;
    edge.place_nm = e == 0 ? -41.1 : 41.1;
    s.data.edges.push_back(edge);
    for (int row = 0; row < s.data.rows; ++row)
      for (double u = -30; u < 30; u += 2.3)
        s.data.samples.push_back(
            {e, row, (e == 0 ? 1 : -1) * (u - 41 + 0.1 * row), 300 * signal(u, n) + 50});
  }
  return s;
}

ProfileFitOptions usual() {
  ProfileFitOptions o;
  o.prior_mean = box.middle;
  o.prior_deviation.fill(std::numeric_limits<double>::infinity());
  o.prior_deviation[profile_top] = o.prior_deviation[profile_foot] = 0;
  return o;
}

// Variances follow the level: they must not change with the numbers of a step, or no step along
// the gradient leads down.
TEST(SightOfWalls, TheObjectivesGradientIsItsDerivative) {
  const ProfileLibrary walls = library();
  const ProfileSight s = sight(walls);
  const ProfileFitOptions options = usual();
  SimulationErrors errors(-35, 35, 4);
  SightOfWalls own(s, options, errors);
  WallLayout layout;
  layout.free = {profile_height, profile_angle};
  const int first = layout.errors() + errors.numbers();
  layout.width = first + own.numbers();
  Walls at{box.middle, box.middle};
  own.begin(at);
  own.estimate_noise(at);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(layout.width + 1);
  step(first) = 0.1, step(first + 1) = 5;
  for (int e = 0; e < own.edges(); ++e) step(first + own.edge(e)) = 0.7;
  own.move(step, first);
  own.weigh(at);
  const auto normal = [&](const SightOfWalls& of, const Walls& there) {
    ProfileNormal out{Eigen::MatrixXd::Zero(layout.width + 1, layout.width + 1),
                      Eigen::VectorXd::Zero(layout.width + 1), 0};
    of.add_to(layout, first, there, false, out);
    return out;
  };
  const ProfileNormal here = normal(own, at);
  const auto by_differences = [&](int i, double size) {
    const auto value = [&](double by) {
      SightOfWalls moved = own;
      Walls there = at;
      Eigen::VectorXd d = Eigen::VectorXd::Zero(layout.width + 1);
      d(i) = by;
      moved.move(d, first);
      for (ProfileNumbers& wall : there) {
        wall[profile_height] += d(0), wall[profile_angle] += d(1);
        wall[profile_width] += d(layout.width);
      }
      return normal(moved, there).value;
    };
    return (value(size) - value(-size)) / (2 * size);
  };
  std::vector<int> numbers{0, 1, layout.width};
  for (int i = first; i < layout.width; ++i) numbers.push_back(i);
  for (const int i : numbers) {
    const double deviation = 1 / std::sqrt(here.matrix(i, i));
    EXPECT_NEAR(-here.pull(i) * deviation, by_differences(i, 1e-3 * deviation) * deviation,
                1e-3 * (1 + std::abs(here.pull(i) * deviation)))
        << i;
  }
}

// Edges that move apart make another width, and so another signal.
TEST(SightOfWalls, ANumberThatFollowsOthersIsAChainOfDerivatives) {
  const Eigen::MatrixXd residuals_by = Eigen::MatrixXd::Random(9, 4);
  const Eigen::VectorXd residuals = Eigen::VectorXd::Random(9), by = Eigen::VectorXd::Random(3);
  const ProfileNormal all{residuals_by.transpose() * residuals_by,
                          residuals_by.transpose() * residuals, 2.5};
  const ProfileNormal out = followed(all, by);
  const Eigen::MatrixXd chained = residuals_by.leftCols(3) + residuals_by.col(3) * by.transpose();
  EXPECT_LT((out.matrix - chained.transpose() * chained).norm(), 1e-12);
  EXPECT_LT((out.pull - chained.transpose() * residuals).norm(), 1e-12);
  EXPECT_EQ(out.value, 2.5);
}

}  // namespace
}  // namespace surf
