// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/fit_profile.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "follow_rows.h"
#include "sight_of_walls.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int most_rounds = 12, steps_per_round = 4;
constexpr double settled_nm = 0.02;
constexpr double hardly_told =
    0.1;  // heights and radii, known to nanometres, settle ten times as coarsely
// Of the model's error, which may show. Tiers of physics differ by 1.3 to 2.7 % of the contrast.
constexpr std::array shares{1.0, 0.5, 0.25};
constexpr double scales_agree = 0.005;  // of images, standard error
constexpr double degree = std::numbers::pi / 180;
constexpr double known_height = 0.05;  // its standard error, over it
constexpr double beyond_box = 1.2;     // of the box's half sizes: further away no quadratic holds

class Fit {
 public:
  Fit(const std::vector<ProfileSight>& sights, const ProfileFitOptions& options)
      : options_(options), errors_(errors_of(sights, options)) {
    box_ = sights.front().left->box();
    for (std::size_t k = 0; k < profile_numbers; ++k)
      if (k != profile_width && options.prior_deviation[k] > 0 && box_.half[k] > 0)
        layout_.free.push_back(k);
    layout_.walls = options.walls_alike || one_side_only(sights) ? 1 : 2;
    walls_[0] = walls_[1] = box_.middle;
    for (auto& side : walls_)
      for (std::size_t k = 0; k < profile_numbers; ++k)
        if ((k != profile_width && options.prior_deviation[k] == 0) ||
            (k == profile_height && options.hold_height))
          side[k] = options.prior_mean[k];
    for (const ProfileSight& sight : sights) {
      first_.push_back(all_);
      sights_.emplace_back(sight, options, errors_);
      all_ += sights_.back().numbers();
    }
    const int before = layout_.errors() + errors_.numbers();
    for (int& first : first_) first += before;
    all_ += before;
    if (options.shading_doubt_nm > 0 &&
        std::ranges::any_of(sights, &ProfileSight::shows_shading_alone)) {
      layout_.shading = all_++;
      const double a = box_.middle[profile_angle] * degree;
      layout_.angle_by_shading = std::sin(a) * std::cos(a) / box_.middle[profile_height] / degree;
    }
    layout_.width = all_;
    width_now();
    for (SightOfWalls& sight : sights_) sight.begin(walls_);
    width_now();
  }

  ProfileFit run() {
    const bool converged = settle();
    for (int step = 0; step < steps_per_round; ++step) {
      options_.watch.check();
      improve();
    }
    return result(converged);
  }

 private:
  static SimulationErrors errors_of(const std::vector<ProfileSight>& sights,
                                    const ProfileFitOptions& options) {
    if (sights.empty()) throw InvalidInput("SEM image", "there is none", "Give one");
    double first = HUGE_VAL, last = -HUGE_VAL;
    for (const ProfileSight& sight : sights) {
      first = std::min(first, sight.left->first_u_nm());
      last = std::max(last, sight.left->last_u_nm());
    }
    return {first, last, options.model_error_nm};
  }

  static bool one_side_only(const std::vector<ProfileSight>& sights) {
    const auto right = [](const ImageEdge& e) { return e.material_right; };
    const auto all = [&](auto holds) {
      return std::ranges::all_of(
          sights, [&](const ProfileSight& s) { return std::ranges::all_of(s.data.edges, holds); });
    };
    return all(right) || all([&](const ImageEdge& e) { return !right(e); });
  }

  /// Walls as an image sees them.
  Walls walls_of(const SightOfWalls& sight) const {
    Walls out = walls_;
    if (sight.shows_shading_alone())
      for (auto& side : out) {
        side[profile_height] += shading_off_nm_;
        side[profile_angle] += layout_.angle_by_shading * shading_off_nm_;
      }
    return out;
  }

  /// Mean places of all edges of all images.
  std::vector<double> places() const {
    std::vector<double> out;
    for (const SightOfWalls& sight : sights_) {
      const std::vector<double> mean = sight.means();
      out.insert(out.end(), mean.begin(), mean.end());
    }
    return out;
  }

  void width_now() {
    const double width = mean_width().nm;
    if (!(width > 0)) return;
    for (auto& side : walls_) side[profile_width] = clamped(profile_width, width);
    width_beyond_ = walls_[0][profile_width] != width;
  }

  double clamped(std::size_t k, double value) const {
    const double room = beyond_box * box_.half[k];
    value = std::clamp(value, box_.middle[k] - room, box_.middle[k] + room);
    return k == profile_top || k == profile_foot ? std::max(value, 0.0) : value;
  }

  /// How far the walls' numbers moved, in such units that `settled_nm` is nothing: of what an image
  /// hardly tells, rounds may go to and fro by a small part of its error.
  double walls_moved(const Walls& before) const {
    constexpr double of_error = 0.05;
    if (layout_.free.empty()) return 0;
    const auto solver = normal().matrix.ldlt();
    double moved = 0;
    for (int side = 0; side < layout_.walls; ++side)
      for (std::size_t i = 0; i < layout_.free.size(); ++i) {
        const std::size_t k = layout_.free[i], wall = static_cast<std::size_t>(side);
        const int at = layout_.wall(side) + static_cast<int>(i);
        const double variance = solver.solve(Eigen::VectorXd::Unit(all_, at))(at),
                     nothing = k == profile_angle ? settled_nm : settled_nm / hardly_told,
                     little = of_error * std::sqrt(std::max(0.0, variance));
        moved = std::max(moved, std::abs(walls_[wall][k] - before[wall][k]) * settled_nm /
                                    std::max(nothing, little));
      }
    return moved;
  }

  /// Steps until nothing moves. False: it still did.
  bool settle() {
    if (height_known()) errors_.set_share(shares.back());
    bool converged = false;
    for (int round = 0; round < most_rounds && !converged; ++round) {
      options_.watch.report(round, most_rounds);
      const std::vector<double> before = places();
      const Walls walls_before = walls_;
      for (int step = 0; step < steps_per_round; ++step) {
        options_.watch.check();
        if (!improve()) break;
      }
      for (SightOfWalls& sight : sights_) {
        sight.place_rows(walls_of(sight));
        sight.follow();
        sight.estimate_noise(walls_of(sight));
      }
      if (height_known()) weigh_errors();
      double moved = 0;
      const std::vector<double> now = places();
      for (std::size_t e = 0; e < now.size(); ++e)
        moved = std::max(moved, std::abs(now[e] - before[e]));
      moved = std::max(moved, walls_moved(walls_before));
      converged = round > 1 && moved < settled_nm;
    }
    return converged;
  }

  /// The negative logarithm of the posterior, and its Gauss-Newton equations.
  ProfileNormal normal() const {
    ProfileNormal out = before_prior_of_errors();
    errors_.add_prior(layout_.errors(), out.value, out.pull, out.matrix);
    return out;
  }

  /// The same without what is known beforehand of the simulation's errors.
  ProfileNormal before_prior_of_errors() const {
    ProfileNormal out = of_data_and_shapes();
    hold_heights(out);
    return out;
  }

  ProfileNormal of_data_and_shapes(bool of_errors = false) const {
    const int with_width = all_ + 1;
    ProfileNormal out{Eigen::MatrixXd::Zero(with_width, with_width),
                      Eigen::VectorXd::Zero(with_width), 0};
    for (std::size_t k = 0; k < sights_.size(); ++k)
      sights_[k].add_to(layout_, first_[k], walls_of(sights_[k]), of_errors, out);
    out = followed(out, width_by_edges());
    if (options_.one_feature) share_width(out);
    if (const int i = layout_.shading; i >= 0) {
      const double precision = 1 / (options_.shading_doubt_nm * options_.shading_doubt_nm);
      out.value += 0.5 * shading_off_nm_ * shading_off_nm_ * precision;
      out.pull(i) -= shading_off_nm_ * precision;
      out.matrix(i, i) += precision;
    }
    for (int side = 0; side < layout_.walls; ++side)
      for (std::size_t k = 0; k < layout_.free.size(); ++k) {
        const std::size_t number = layout_.free[k];
        const double deviation = options_.prior_deviation[number];
        if (!std::isfinite(deviation)) continue;
        const double off = walls_[static_cast<std::size_t>(side)][number] -
                           options_.prior_mean[number],
                     precision = 1 / (deviation * deviation);
        const int i = layout_.wall(side) + static_cast<int>(k);
        out.value += 0.5 * off * off * precision;
        out.pull(i) -= off * precision;
        out.matrix(i, i) += precision;
      }
    return out;
  }

  /// Places of heights that are held, in the fit's vector.
  std::vector<Eigen::Index> held() const {
    std::vector<Eigen::Index> out;
    const auto at = std::ranges::find(layout_.free, std::size_t{profile_height});
    if (options_.hold_height && at != layout_.free.end())
      for (int side = 0; side < layout_.walls; ++side)
        out.push_back(layout_.wall(side) + (at - layout_.free.begin()));
    return out;
  }

  /// Equations of the other numbers, at these heights.
  void hold_heights(ProfileNormal& out) const {
    for (const Eigen::Index i : held()) {
      out.matrix.row(i).setZero(), out.matrix.col(i).setZero();
      out.matrix(i, i) = 1, out.pull(i) = 0;
    }
  }

  /// Widths of an image's features, and their derivatives by the fit's numbers.
  struct Widths {
    std::vector<double> nm;
    std::vector<Eigen::VectorXd> by_number;
  };
  Widths widths_of(std::size_t image) const {
    const SightOfWalls& sight = sights_[image];
    const std::vector<double> mean = sight.means();
    const double longer = 1 / sight.shortening();
    Widths out;
    const auto add = [&](std::size_t edge, double factor) {
      out.nm.back() += factor * longer * mean[edge];
      out.by_number.back()(first_[image] + sight.edge(static_cast<int>(edge))) += factor * longer;
    };
    const auto another = [&] {
      out.nm.push_back(0);
      out.by_number.emplace_back(Eigen::VectorXd::Zero(all_));
    };
    sight.for_each_pair([&](std::size_t a, std::size_t b) {
      another();
      add(a, -1);
      add(b, 1);
    });
    if (out.nm.empty() && box_.half[profile_width] > 0) {
      another();
      add(0, 2);
    }
    return out;
  }

  /// The mean width of all images and its derivatives.
  struct MeanWidth {
    double nm = 0;
    Eigen::VectorXd by_number;
    int images = 0;
  };
  MeanWidth mean_width() const {
    MeanWidth out{0, Eigen::VectorXd::Zero(all_), 0};
    for (std::size_t k = 0; k < sights_.size(); ++k) {
      const Widths widths = widths_of(k);
      if (widths.nm.empty()) continue;
      ++out.images;
      const double share = 1 / static_cast<double>(widths.nm.size());
      for (std::size_t i = 0; i < widths.nm.size(); ++i) {
        out.nm += share * widths.nm[i];
        out.by_number += share * widths.by_number[i];
      }
    }
    if (out.images > 0) out.nm /= out.images, out.by_number /= out.images;
    return out;
  }

  /// All images show one feature, whose width they share as far as their scales agree.
  void share_width(ProfileNormal& out) const {
    const MeanWidth mean = mean_width();
    const double deviation = scales_agree * box_.middle[profile_width],
                 precision = 1 / (deviation * deviation);
    for (std::size_t k = 0; k < sights_.size(); ++k) {
      const Widths own = widths_of(k);
      for (std::size_t i = 0; i < own.nm.size(); ++i) {
        const double off = own.nm[i] - mean.nm;
        const Eigen::VectorXd by = own.by_number[i] - mean.by_number;
        out.value += 0.5 * precision * off * off;
        out.pull -= precision * off * by;
        out.matrix += precision * by * by.transpose();
      }
    }
  }

  /// Derivatives of the walls' width, which stays within the libraries' box.
  Eigen::VectorXd width_by_edges() const {
    return width_beyond_ ? Eigen::VectorXd(Eigen::VectorXd::Zero(all_)) : mean_width().by_number;
  }

  void weigh() {
    for (SightOfWalls& sight : sights_) sight.weigh(walls_of(sight));
  }

  void move(const Eigen::VectorXd& step) {
    for (int side = 0; side < layout_.walls; ++side)
      for (std::size_t k = 0; k < layout_.free.size(); ++k) {
        const std::size_t number = layout_.free[k];
        double& value = walls_[static_cast<std::size_t>(side)][number];
        value = clamped(number, value + step(layout_.wall(side) + static_cast<int>(k)));
      }
    if (layout_.walls == 1) walls_[1] = walls_[0];
    if (layout_.shading >= 0) shading_off_nm_ += step(layout_.shading);
    errors_.move(step, layout_.errors());
    for (std::size_t k = 0; k < sights_.size(); ++k) sights_[k].move(step, first_[k]);
    width_now();
  }

  /// One Gauss-Newton step, shortened until it lowers the objective.
  bool improve() {
    weigh();
    const ProfileNormal now = normal();
    const Eigen::VectorXd step = now.matrix.ldlt().solve(now.pull);
    const Walls walls = walls_;
    const std::vector<SightOfWalls> sights = sights_;
    const SimulationErrors errors = errors_;
    const double shading_off_nm = shading_off_nm_;
    for (double share = 1; share > 1e-3; share *= 0.3) {
      move(share * step);
      if (normal().value < now.value + 1e-9 * std::abs(now.value)) return step.norm() > 1e-6;
      walls_ = walls, sights_ = sights, errors_ = errors, shading_off_nm_ = shading_off_nm;
      width_now();
    }
    return false;
  }

  /// Where heights are found, what the simulation is off by at flanks looks like another height:
  /// all that it may be off by counts.
  bool height_known() const {
    return options_.hold_height || options_.prior_deviation[profile_height] <=
                                       known_height * options_.prior_mean[profile_height];
  }

  /// How much of what the simulation may be off by shows, by its marginal likelihood (an empirical
  /// prior: MacKay 1992, doi:10.1162/neco.1992.4.3.415), with the data's equations taken at this
  /// point. Root mean square over what it may be, so that few data leave it large.
  void weigh_errors() {
    constexpr double least = std::numeric_limits<double>::min();  // what the data do not tell
    weigh();
    const ProfileNormal data = before_prior_of_errors();
    SimulationErrors errors = errors_;
    std::array<double, shares.size()> evidence{};
    for (std::size_t i = 0; i < shares.size(); ++i) {
      errors.set_share(shares[i]);
      ProfileNormal all = data;
      errors.add_prior(layout_.errors(), all.value, all.pull, all.matrix);
      const auto solver = all.matrix.ldlt();
      evidence[i] = 0.5 * (all.pull.dot(solver.solve(all.pull)) + errors.log_prior_determinant() -
                           solver.vectorD().array().max(least).log().sum()) -
                    all.value;
    }
    const double most = std::ranges::max(evidence);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const double weight = std::exp(evidence[i] - most);
      sum += weight, squares += weight * shares[i] * shares[i];
    }
    if (const double mean = squares / sum; std::isfinite(mean)) errors_.set_share(std::sqrt(mean));
  }

  /// With what the libraries' own errors move the fit by.
  Eigen::MatrixXd covariance() {
    weigh();
    const ProfileNormal free = of_data_and_shapes(true);
    ProfileNormal now = free;
    hold_heights(now);
    errors_.add_prior(layout_.errors(), now.value, now.pull, now.matrix);
    Eigen::MatrixXd by_noise = now.matrix.ldlt().solve(Eigen::MatrixXd::Identity(all_, all_)), out;
    Eigen::VectorXd by_height = Eigen::VectorXd::Zero(all_);
    for (const Eigen::Index i : held()) by_noise(i, i) = 0;
    for (const Eigen::Index i : held()) by_height -= by_noise * free.matrix.col(i);
    for (const Eigen::Index i : held()) by_height(i) = 1;
    by_height *= options_.prior_deviation[profile_height];
    out = by_noise + by_height * by_height.transpose();
    // Images that share a library share its errors.
    std::vector<bool> added(sights_.size(), false);
    for (std::size_t k = 0; k < sights_.size(); ++k) {
      if (added[k]) continue;
      Eigen::MatrixXd pull =
          sights_[k].pull_of_library(layout_, first_[k], walls_of(sights_[k]), all_ + 1);
      for (std::size_t i = k + 1; i < sights_.size(); ++i) {
        if (!sights_[i].shares_library(sights_[k])) continue;
        added[i] = true;
        pull += sights_[i].pull_of_library(layout_, first_[i], walls_of(sights_[i]), all_ + 1);
      }
      const Eigen::MatrixXd moved =
          by_noise * (pull.topRows(all_) + width_by_edges() * pull.bottomRows(1));
      out += moved * moved.transpose();
    }
    return out;
  }

  ProfileFit result(bool converged) {
    ProfileFit out;
    out.converged = converged;
    out.at_border = width_beyond_;
    const Eigen::MatrixXd known = covariance();
    for (int side = 0; side < 2; ++side) {
      auto& wall = side == 0 ? out.left : out.right;
      for (std::size_t k = 0; k < profile_numbers; ++k) {
        wall[k].value = walls_[static_cast<std::size_t>(side)][k];
        const auto at = std::ranges::find(layout_.free, k);
        if (at == layout_.free.end()) continue;
        const int i = layout_.wall(side) + static_cast<int>(at - layout_.free.begin());
        wall[k].standard_error = std::sqrt(std::max(known(i, i), 0.0));
        // What is known beforehand may lie there: the library's box is its prior's.
        if (std::isfinite(options_.prior_deviation[k])) continue;
        out.at_border = out.at_border ||
                        std::abs(wall[k].value - box_.middle[k]) > beyond_box * box_.half[k] - 1e-9;
      }
    }
    for (SightOfWalls& sight : sights_) sight.place_rows(walls_of(sight));
    for (std::size_t k = 0; k < sights_.size(); ++k)
      out.sights.push_back(sights_[k].result(walls_of(sights_[k]), known, first_[k]));
    add_widths(known, out);
    add_roughness(out);
    return out;
  }

  /// The widths that the first image shows, and the mean width of all images.
  void add_widths(const Eigen::MatrixXd& covariance, ProfileFit& out) const {
    const auto error = [&](const Eigen::VectorXd& by_number) {
      return std::sqrt(std::max(0.0, by_number.dot(covariance * by_number)));
    };
    const Widths first = widths_of(0);
    for (std::size_t i = 0; i < first.nm.size(); ++i)
      out.widths_nm.push_back({first.nm[i], error(first.by_number[i])});
    if (const MeanWidth all = mean_width(); all.images > 0)
      out.left[profile_width] = out.right[profile_width] = {all.nm, error(all.by_number)};
  }

  void add_roughness(ProfileFit& out) const {
    const SightOfWalls& sight = sights_.front();
    const ProfileData& data = sight.data();
    if (static_cast<std::size_t>(data.rows) < fewest_rows_with_spectrum) return;
    out.edge_spectrum =
        surf::edge_spectrum(without_middle(sight.raw(), data.closed), data.row_distance_nm);
    out.edge_roughness = fit_roughness(out.edge_spectrum, sight.edges(), data.row_distance_nm);
    std::vector<std::vector<double>> widths;
    sight.for_each_pair([&](std::size_t a, std::size_t b) {
      widths.push_back(sight.raw()[b]);
      for (std::size_t r = 0; r < widths.back().size(); ++r) widths.back()[r] -= sight.raw()[a][r];
    });
    if (widths.empty()) return;
    out.width_spectrum = surf::edge_spectrum(widths, data.row_distance_nm);
    out.width_roughness =
        fit_roughness(out.width_spectrum, static_cast<int>(widths.size()), data.row_distance_nm);
  }

  const ProfileFitOptions& options_;
  ProfileBox box_;
  WallLayout layout_;
  Walls walls_{};
  SimulationErrors errors_;
  std::vector<SightOfWalls> sights_;
  std::vector<int> first_;  // of each image's numbers
  int all_ = 0;
  double shading_off_nm_ = 0;  // of the height
  bool width_beyond_ = false;  // of the libraries' box
};

}  // namespace

ProfileFit fit_profile(const std::vector<ProfileSight>& sights, const ProfileFitOptions& options) {
  return Fit(sights, options).run();
}

ProfileFit fit_profile(const ProfileData& data, const ProfileLibrary& library,
                       const ProfileFitOptions& options) {
  return fit_profile({{data, &library, &library}}, options);
}

}  // namespace surf
