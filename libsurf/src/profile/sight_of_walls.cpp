// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight_of_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "follow_rows.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int row_steps = 2, fewest_pixels = 16;
constexpr double least_weight = 0.1;  // of the usual row's: rows that tell less are not seen
constexpr double degree = std::numbers::pi / 180;

double median_of(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

/// From what values at places do to what their independent errors, of one deviation, do.
void spread(Eigen::Ref<Eigen::MatrixXd> pull, const ProfileLibrary& library) {
  const Eigen::MatrixXd by_values = pull;
  const std::vector<double>& blur = library.blur();
  const auto reach = static_cast<Eigen::Index>(blur.size()) - 1;
  for (Eigen::Index k = 0; k < pull.cols(); ++k) {
    pull.col(k).setZero();
    for (Eigen::Index other = std::max<Eigen::Index>(0, k - reach);
         other <= std::min(pull.cols() - 1, k + reach); ++other)
      pull.col(k) += blur[static_cast<std::size_t>(std::abs(other - k))] * by_values.col(other);
    pull.col(k) *= std::sqrt(library.variances()[static_cast<std::size_t>(k)]);
  }
}

}  // namespace

ProfileNormal followed(const ProfileNormal& all, const Eigen::VectorXd& last_by_others) {
  const Eigen::VectorXd& by = last_by_others;
  const Eigen::Index last = by.size();
  const Eigen::VectorXd column = all.matrix.col(last).head(last);
  ProfileNormal out{all.matrix.topLeftCorner(last, last), all.pull.head(last) + all.pull(last) * by,
                    all.value};
  out.matrix += column * by.transpose() + by * column.transpose() +
                all.matrix(last, last) * by * by.transpose();
  return out;
}

SightOfWalls::SightOfWalls(const ProfileSight& sight, const ProfileFitOptions& options,
                           SimulationErrors& errors)
    : sight_(&sight), options_(&options), simulation_(&errors) {
  const double a = sight.azimuth_deg * degree, t = sight.tilt_deg * degree;
  toward_x_ = std::cos(a);
  const double x = std::sin(t) * std::cos(a);
  shortening_ = 1 - x * x / (1 + std::cos(t));
  for (const int side : {0, 1})
    looks_[static_cast<std::size_t>(side)] =
        errors.look({sight.signal, sight.tilt_deg * tilted_by(side), sight.tilt_deg * std::sin(a)});
  const auto rows = static_cast<std::size_t>(sight.data.rows);
  for (const ImageEdge& e : sight.data.edges) {
    places_.emplace_back(rows, e.place_nm);
    raw_.emplace_back(rows, e.place_nm);
    errors_.emplace_back(rows, 0.0);
  }
  std::vector<int> pixels(sight.data.edges.size(), 0);
  for (const ProfileSample& s : sight.data.samples) ++pixels[static_cast<std::size_t>(s.edge)];
  if (pixels.empty() || std::ranges::any_of(pixels, [](int n) { return n < fewest_pixels; }))
    throw InvalidInput("SEM image", "an edge has fewer than 16 pixels", "Give a larger image");
}

std::vector<double> SightOfWalls::means() const {
  std::vector<double> out;
  for (const auto& rows : places_) {
    double sum = 0;
    for (const double x : rows) sum += x / static_cast<double>(rows.size());
    out.push_back(sum);
  }
  return out;
}

double SightOfWalls::u_of(const ProfileSample& s) const {
  const auto e = static_cast<std::size_t>(s.edge);
  return sign_of(edge_of(s)) * (s.x_nm - places_[e][static_cast<std::size_t>(s.row)]);
}

ProfileNumbers SightOfWalls::seen(const Walls& walls, int side) const {
  ProfileNumbers numbers = walls[static_cast<std::size_t>(side)];
  numbers[profile_angle] += tilted_by(side) * tilt_off_deg_;
  return numbers;
}

double SightOfWalls::model(const ProfileLibrary::Value& v, double u, int side) const {
  return gain_ * (signal(v) + off_by(u, side)) + offset_;
}

double SightOfWalls::variance_of(double level) const {
  return std::max(noise_[0] + noise_[1] * level, least_variance_);
}

void SightOfWalls::move_outward(double by_nm, int edge) {
  for (std::size_t e = 0; e < places_.size(); ++e) {
    if (edge != all_edges && edge != static_cast<int>(e)) continue;
    const double by = sign_of(sight_->data.edges[e]) * by_nm;
    for (double& x : places_[e]) x -= by;
    for (double& x : raw_[e]) x -= by;
  }
}

void SightOfWalls::search(const Walls& walls, double farthest_nm, int edge) {
  constexpr double step_nm = 0.25;
  double best = 0, least = HUGE_VAL;
  for (double at = -farthest_nm; at <= farthest_nm; at += step_nm) {
    move_outward(at, edge);
    const double left = scale(walls, edge);
    move_outward(-at, edge);
    if (left < least) least = left, best = at;
  }
  move_outward(best, edge);
}

// Where edges lie best: thresholds are off by nanometres, and chance in the library makes small
// valleys in between, in which steps would end.
void SightOfWalls::begin(const Walls& walls) {
  constexpr double thresholds_off_nm = 6;
  if (sight_->search_nm > 0)
    for (int e = 0; e < edges(); ++e) search(walls, sight_->search_nm, e);
  else search(walls, thresholds_off_nm);
  scale(walls);
  constexpr double least = 1e-6;  // a prior of no width has no inverse
  for (const int look : looks_)
    simulation_->set_deviation(look, std::max(options_->model_error, least) * contrast_);
}

double SightOfWalls::scale(const Walls& walls, int edge) {
  double n = 0, s = 0, y = 0, ss = 0, sy = 0, yy = 0;
  for (const ProfileSample& p : sight_->data.samples) {
    if (edge != all_edges && edge != p.edge) continue;
    const int side = side_of(edge_of(p));
    const double v = library(side).at(u_of(p), seen(walls, side)).value;
    ++n, s += v, y += p.value, ss += v * v, sy += v * p.value, yy += p.value * p.value;
  }
  const double spread = ss - s * s / n, both = sy - s * y / n, own = yy - y * y / n;
  gain_ = spread > 0 ? std::max(1e-12, both / spread) : 1;
  offset_ = (y - gain_ * s) / n;
  noise_ = {std::max(1e-12, own / n) * 0.25, 0};
  least_variance_ = 1e-6 * noise_[0];
  double low = HUGE_VAL, high = -HUGE_VAL;
  const ProfileLibrary& l = *sight_->left;
  for (double u = l.first_u_nm(); u <= l.last_u_nm(); u += 1) {
    const double v = l.at(u, walls[0]).value;
    low = std::min(low, v), high = std::max(high, v);
  }
  contrast_ = high - low;
  return (own - 2 * gain_ * both + gain_ * gain_ * spread) / n;
}

double SightOfWalls::slope_around(double u, int side, const ProfileNumbers& numbers) const {
  const ProfileLibrary& l = library(side);
  const double reach = std::max(2 * l.step_nm(), 2.0);
  return (l.at(u + reach, numbers).value - l.at(u - reach, numbers).value) / (2 * reach);
}

void SightOfWalls::derivatives(const WallLayout& layout, int first, const ProfileSample& s,
                               double u, const ProfileLibrary::Value& v, double slope,
                               Derivatives& d) const {
  const int side = side_of(edge_of(s));
  d.clear();
  d.emplace_back(first, (signal(v) + off_by(u, side)) * gain_);  // of the gain's logarithm
  d.emplace_back(first + 1, 1);
  for (std::size_t k = 0; k < layout.free.size(); ++k)
    d.emplace_back(layout.wall(side) + static_cast<int>(k), gain_ * v.by_number[layout.free[k]]);
  d.emplace_back(first + edge(s.edge), -sign_of(edge_of(s)) * gain_ * slope);
  d.emplace_back(layout.width, gain_ * v.by_number[profile_width]);
  if (layout.shading >= 0 && sight_->shows_shading_alone)
    d.emplace_back(layout.shading, gain_ * (v.by_number[profile_height] +
                                            layout.angle_by_shading * v.by_number[profile_angle]));
  const SimulationErrors::Sum sum = simulation_->at(looks_[static_cast<std::size_t>(side)], u);
  for (std::size_t i = 0; i < sum.numbers.size(); ++i)
    d.emplace_back(layout.errors() + sum.numbers[i], gain_ * sum.weights[i]);
  if (sight_->tilt_error_deg > 0)
    d.emplace_back(first + tilt(), gain_ * tilted_by(side) * v.by_number[profile_angle]);
}

void SightOfWalls::weigh(const Walls& walls) {
  const std::array<ProfileNumbers, 2> numbers{seen(walls, 0), seen(walls, 1)};
  variances_.clear();
  for (const ProfileSample& s : sight_->data.samples) {
    const int side = side_of(edge_of(s));
    const double u = u_of(s);
    variances_.push_back(
        variance_of(model(library(side).at(u, numbers[static_cast<std::size_t>(side)]), u, side)));
  }
}

void SightOfWalls::add_to(const WallLayout& layout, int first, const Walls& walls, bool of_errors,
                          ProfileNormal& out) const {
  const std::array<ProfileNumbers, 2> numbers{seen(walls, 0), seen(walls, 1)};
  Derivatives d;
  for (std::size_t at = 0; at < sight_->data.samples.size(); ++at) {
    const ProfileSample& s = sight_->data.samples[at];
    const int side = side_of(edge_of(s));
    const ProfileNumbers& own = numbers[static_cast<std::size_t>(side)];
    const double u = u_of(s);
    const ProfileLibrary::Value v = library(side).at(u, own);
    const double variance = variances_[at], off = s.value - model(v, u, side);
    derivatives(layout, first, s, u, v, of_errors ? slope_around(u, side, own) : v.by_u, d);
    out.value += 0.5 * off * off / variance;
    for (const auto& [i, by_i] : d) {
      out.pull(i) += by_i * off / variance;
      for (const auto& [k, by_k] : d) out.matrix(i, k) += by_i * by_k / variance;
    }
  }
  const auto prior = [&](int i, double off, double deviation) {
    out.value += 0.5 * off * off / (deviation * deviation);
    out.pull(i) -= off / (deviation * deviation);
    out.matrix(i, i) += 1 / (deviation * deviation);
  };
  const double known = sight_->tilt_error_deg;
  prior(first + tilt(), tilt_off_deg_, known > 0 ? known : 1);  // 1: held, as it never moves
}

Eigen::MatrixXd SightOfWalls::pull_of_library(const WallLayout& layout, int first,
                                              const Walls& walls, int all) const {
  const bool apart = sight_->left != sight_->right;
  const auto places = static_cast<Eigen::Index>(sight_->left->variances().size());
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(
      all, apart ? places + static_cast<Eigen::Index>(sight_->right->variances().size()) : places);
  Derivatives d;
  for (std::size_t at = 0; at < sight_->data.samples.size(); ++at) {
    const ProfileSample& s = sight_->data.samples[at];
    const double u = u_of(s);
    const int side = side_of(edge_of(s));
    const ProfileNumbers numbers = seen(walls, side);
    const ProfileLibrary::Value v = library(side).at(u, numbers);
    derivatives(layout, first, s, u, v, slope_around(u, side, numbers), d);
    const Eigen::Index from = apart && side == 1 ? places : 0;
    for (std::size_t i = 0; i < v.places.size(); ++i)
      for (const auto& [number, by_number] : d)
        pull(number, from + static_cast<Eigen::Index>(v.places[i])) +=
            by_number * gain_ * v.weights[i] / variances_[at];
  }
  spread(pull.leftCols(places), *sight_->left);
  if (apart) spread(pull.rightCols(pull.cols() - places), *sight_->right);
  return pull;
}

void SightOfWalls::move(const Eigen::VectorXd& step, int first) {
  constexpr double farthest_nm = 20, farthest_deg = 2;
  gain_ *= std::exp(std::clamp(step(first), -0.5, 0.5));
  offset_ += step(first + 1);
  for (std::size_t e = 0; e < places_.size(); ++e) {
    const double by =
        std::clamp(step(first + edge(static_cast<int>(e))), -farthest_nm, farthest_nm);
    for (double& x : places_[e]) x += by;
    for (double& x : raw_[e]) x += by;
  }
  if (sight_->tilt_error_deg > 0)
    tilt_off_deg_ += std::clamp(step(first + tilt()), -farthest_deg, farthest_deg);
}

void SightOfWalls::place_rows(const Walls& walls) {
  raw_ = places_;
  const std::array<ProfileNumbers, 2> numbers{seen(walls, 0), seen(walls, 1)};
  for (int step = 0; step < row_steps; ++step) {
    std::vector<std::vector<double>> pull, weight;
    for (const auto& rows : raw_) {
      pull.emplace_back(rows.size(), 0.0);
      weight.emplace_back(rows.size(), 0.0);
    }
    for (const ProfileSample& s : sight_->data.samples) {
      const auto e = static_cast<std::size_t>(s.edge), r = static_cast<std::size_t>(s.row);
      const ImageEdge& edge = edge_of(s);
      const int side = side_of(edge);
      const double u = sign_of(edge) * (s.x_nm - raw_[e][r]);
      const ProfileLibrary::Value v = library(side).at(u, numbers[static_cast<std::size_t>(side)]);
      const double m = model(v, u, side), variance = variance_of(m),
                   slope = -sign_of(edge) * gain_ * v.by_u;
      pull[e][r] += slope * (s.value - m) / variance;
      weight[e][r] += slope * slope / variance;
    }
    for (std::size_t e = 0; e < raw_.size(); ++e)
      for (std::size_t r = 0; r < raw_[e].size(); ++r) {
        // A row whose wall is not seen stays where its neighbours say.
        if (!(weight[e][r] > least_weight * median_of(weight[e]))) {
          errors_[e][r] = std::numeric_limits<double>::quiet_NaN();
          continue;
        }
        raw_[e][r] += std::clamp(pull[e][r] / weight[e][r], -5.0, 5.0);
        errors_[e][r] = 1 / std::sqrt(weight[e][r]);
      }
  }
}

void SightOfWalls::follow() {
  FollowedRows followed =
      follow_rows(raw_, errors_, sight_->data.closed, sight_->data.row_distance_nm);
  places_ = std::move(followed.places_nm);
  blur2_ = followed.blur_nm2;
}

void SightOfWalls::estimate_noise(const Walls& walls) {
  double n = 0, m1 = 0, m2 = 0, r1 = 0, mr = 0;
  for (const ProfileSample& s : sight_->data.samples) {
    const double u = u_of(s);
    const int side = side_of(edge_of(s));
    const double m = model(library(side).at(u, seen(walls, side)), u, side);
    const double r = (s.value - m) * (s.value - m);
    ++n, m1 += m, m2 += m * m, r1 += r, mr += m * r;
  }
  const double spread = m2 - m1 * m1 / n, slope = spread > 0 ? (mr - m1 * r1 / n) / spread : 0,
               mean = r1 / n;
  least_variance_ = 0.1 * mean + std::numeric_limits<double>::min();
  noise_ = slope > 0 ? std::array{mean - slope * m1 / n, slope} : std::array{mean, 0.0};
}

SightFit SightOfWalls::result(const Walls& walls, const Eigen::MatrixXd& covariance,
                              int first) const {
  SightFit out;
  out.gain = gain_, out.offset = offset_, out.blur_nm = std::sqrt(blur2_);
  const auto error = [&](int i) { return std::sqrt(std::max(covariance(i, i), 0.0)); };
  out.tilt_deg = {sight_->tilt_deg + tilt_off_deg_,
                  sight_->tilt_error_deg > 0 ? error(first + tilt()) : 0};
  const std::vector<double> mean = means();
  for (std::size_t e = 0; e < places_.size(); ++e)
    out.edges.push_back({sight_->data.edges[e],
                         {mean[e], error(first + edge(static_cast<int>(e)))},
                         places_[e],
                         raw_[e],
                         errors_[e]});
  out.profiles = profiles(walls);
  double squares = 0;
  const ProfileLibrary& l = *sight_->left;
  int places = 0;
  for (double u = l.first_u_nm(); u <= l.last_u_nm(); u += options_->model_error_nm, ++places)
    for (const int side : {0, 1}) squares += 0.5 * std::pow(off_by(u, side), 2);
  out.discrepancy_share = std::sqrt(squares / places) / contrast_;
  out.unexplained_share = unexplained(out.profiles);
  return out;
}

double SightOfWalls::unexplained(const std::vector<MeanProfile>& profiles) const {
  double n = 0, sum = 0, squares = 0, left = 0, noise = 0;
  for (const MeanProfile& p : profiles)
    for (std::size_t i = 0; i < p.u_nm.size(); ++i) {
      if (!std::isfinite(p.measured[i])) continue;
      ++n, sum += p.measured[i], squares += p.measured[i] * p.measured[i];
      const double by_simulation = gain_ * off_by(p.u_nm[i], p.material_right ? 0 : 1);
      left += std::pow(p.measured[i] - (p.fitted[i] - by_simulation), 2);
      noise += p.standard_error[i] * p.standard_error[i];
    }
  const double variation = squares - sum * sum / n - noise;
  return variation > 0 ? std::sqrt(std::max(left - noise, 0.0) / variation) : 1;
}

std::vector<MeanProfile> SightOfWalls::profiles(const Walls& walls) const {
  constexpr double step = 1;
  std::vector<MeanProfile> out;
  for (int side = 0; side < 2; ++side) {
    const ProfileLibrary& l = library(side);
    const ProfileNumbers numbers = seen(walls, side);
    const int bins = 1 + static_cast<int>((l.last_u_nm() - l.first_u_nm()) / step);
    std::vector<double> sum(static_cast<std::size_t>(bins), 0), at = sum, variance = sum,
                                                                count = sum, fitted = sum;
    for (const ProfileSample& s : sight_->data.samples) {
      if (side_of(edge_of(s)) != side) continue;
      const double u = u_of(s);
      const int bin = static_cast<int>(std::floor((u - l.first_u_nm()) / step));
      if (bin < 0 || bin >= bins) continue;
      const auto b = static_cast<std::size_t>(bin);
      const double m = model(l.at(u, numbers), u, side);
      ++count[b], sum[b] += s.value, at[b] += u, fitted[b] += m, variance[b] += variance_of(m);
    }
    MeanProfile p;
    p.material_right = side == 0;
    for (std::size_t b = 0; b < sum.size(); ++b) {
      if (count[b] == 0) continue;
      p.u_nm.push_back(at[b] / count[b]);
      p.measured.push_back(sum[b] / count[b]);
      p.fitted.push_back(fitted[b] / count[b]);
      p.standard_error.push_back(std::sqrt(variance[b]) / count[b]);
    }
    if (!p.u_nm.empty()) out.push_back(std::move(p));
  }
  return out;
}

}  // namespace surf
