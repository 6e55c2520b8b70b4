// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulation_errors.h"

#include <algorithm>
#include <cmath>

namespace surf {
namespace {

// Physics and detectors also differ in how bright ground and top are, over tens of nanometres.
constexpr double farther = 10;  // of the near places' distance
// Looks that differ by this are correlated by exp(-1/2). How bright ground and top are is off alike
// from wherever they are seen; at a flank it is not.
constexpr double near_alike_deg = 6, far_alike_deg = 60;
constexpr double in_common = 0.99;  // the most that any two looks are correlated by
constexpr double same_deg = 1e-9;

double angle_between(const WallLook& a, const WallLook& b) {
  return std::hypot(a.toward_deg - b.toward_deg,
                    std::abs(a.sideways_deg) - std::abs(b.sideways_deg));
}

int places_within(double range_nm, double distance_nm) {
  return 1 + static_cast<int>(std::ceil(range_nm / distance_nm));
}

}  // namespace

SimulationErrors::SimulationErrors(double first_nm, double last_nm, double near_nm)
    : first_nm_(first_nm), near_nm_(near_nm), far_nm_(farther * near_nm),
      near_(std::max(2, places_within(last_nm - first_nm, near_nm_))),
      far_(std::max(2, places_within(last_nm - first_nm, far_nm_))) {}

int SimulationErrors::look(const WallLook& look) {
  const auto known = std::ranges::find_if(looks_, [&](const WallLook& l) {
    return l.signal == look.signal && angle_between(l, look) < same_deg;
  });
  const auto number = static_cast<int>(known - looks_.begin());
  if (known != looks_.end()) return number;
  looks_.push_back(look);
  deviations_.push_back(1);
  values_.resize(looks_.size() * static_cast<std::size_t>(places()), 0.0);
  return number;
}

void SimulationErrors::set_deviation(int look, double deviation) {
  deviations_[static_cast<std::size_t>(look)] = deviation;
}

SimulationErrors::Sum SimulationErrors::at(int look, double u_nm) const {
  const auto among = [&](double distance_nm, int count) {
    const double place =
        std::clamp((u_nm - first_nm_) / distance_nm, 0.0, static_cast<double>(count - 1) - 1e-9);
    const int before = static_cast<int>(place);
    return std::pair(before, place - before);
  };
  const auto [near, near_share] = among(near_nm_, near_);
  const auto [far, far_share] = among(far_nm_, far_);
  const int first = look * places(), first_far = first + near_;
  return {{first + near, first + near + 1, first_far + far, first_far + far + 1},
          {1 - near_share, near_share, 1 - far_share, far_share}};
}

double SimulationErrors::value(int look, double u_nm) const {
  const Sum sum = at(look, u_nm);
  double value = 0;
  for (std::size_t i = 0; i < sum.numbers.size(); ++i)
    value += sum.weights[i] * values_[static_cast<std::size_t>(sum.numbers[i])];
  return value;
}

void SimulationErrors::move(const Eigen::VectorXd& step, int first) {
  for (std::size_t k = 0; k < values_.size(); ++k)
    values_[k] += step(first + static_cast<Eigen::Index>(k));
}

Eigen::MatrixXd SimulationErrors::covariance(double alike_deg) const {
  const auto looks = static_cast<Eigen::Index>(looks_.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(looks, looks);
  for (Eigen::Index i = 0; i < looks; ++i)
    for (Eigen::Index j = 0; j < looks; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      if (looks_[a].signal != looks_[b].signal) continue;
      const double apart = angle_between(looks_[a], looks_[b]) / alike_deg;
      covariance(i, j) = (i == j ? 1 : in_common * std::exp(-0.5 * apart * apart)) *
                         deviations_[a] * deviations_[b] * share_ * share_;
    }
  return covariance;
}

double SimulationErrors::log_prior_determinant() const {
  const auto of_a_place = [](const Eigen::MatrixXd& covariance) {
    return -covariance.ldlt().vectorD().array().log().sum();
  };
  return near_ * of_a_place(covariance(near_alike_deg)) +
         far_ * of_a_place(covariance(far_alike_deg));
}

void SimulationErrors::add_prior(int first, double& minus_log, Eigen::VectorXd& pull,
                                 Eigen::MatrixXd& matrix) const {
  const auto looks = static_cast<Eigen::Index>(looks_.size());
  const Eigen::MatrixXd of_near = covariance(near_alike_deg).inverse(),
                        of_far = covariance(far_alike_deg).inverse();
  const auto index = [&](Eigen::Index look, int place) {
    return static_cast<std::size_t>(look) * static_cast<std::size_t>(places()) +
           static_cast<std::size_t>(place);
  };
  for (int place = 0; place < places(); ++place) {
    const Eigen::MatrixXd& precision = place < near_ ? of_near : of_far;
    for (Eigen::Index i = 0; i < looks; ++i)
      for (Eigen::Index j = 0; j < looks; ++j) {
        const auto a = first + static_cast<Eigen::Index>(index(i, place)),
                   b = first + static_cast<Eigen::Index>(index(j, place));
        const double other = values_[index(j, place)];
        minus_log += 0.5 * precision(i, j) * values_[index(i, place)] * other;
        pull(a) -= precision(i, j) * other;
        matrix(a, b) += precision(i, j);
      }
  }
}

}  // namespace surf
