// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/fit_profile.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "follow_rows.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int most_rounds = 12, steps_per_round = 4, row_steps = 2;
constexpr double settled_nm = 0.02;
constexpr double beyond_box = 1.2;    // of the box's half sizes: further away no quadratic holds
constexpr double least_weight = 0.1;  // of the usual row's: rows that tell less are not seen

double median_of(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

/// Numbers of the fit in one vector: gain, offset, the walls', a displacement of each edge, and the
/// simulation's error.
struct Layout {
  std::vector<std::size_t> free;  // numbers of a wall that are fitted
  int walls = 1, edges = 0, bumps = 0;

  int wall(int side) const { return 2 + (walls == 1 ? 0 : side) * static_cast<int>(free.size()); }
  int edge(int e) const { return 2 + walls * static_cast<int>(free.size()) + e; }
  int bump(int k) const { return edge(edges) + k; }
  int all() const { return bump(bumps); }
};

class Fit {
 public:
  Fit(const ProfileData& data, const ProfileLibrary& library, const ProfileFitOptions& options)
      : data_(data), library_(library), options_(options) {
    for (std::size_t k = 0; k < profile_numbers; ++k)
      if (k != profile_width && options.prior_deviation[k] > 0 && library.box().half[k] > 0)
        layout_.free.push_back(k);
    layout_.walls = options.walls_alike || one_side_only() ? 1 : 2;
    layout_.edges = static_cast<int>(data.edges.size());
    layout_.bumps = 1 + static_cast<int>(std::ceil((library.last_u_nm() - library.first_u_nm()) /
                                                   options.model_error_nm));
    numbers_[0] = numbers_[1] = library.box().middle;
    for (auto& side : numbers_)
      for (std::size_t k = 0; k < profile_numbers; ++k)
        if (k != profile_width && options.prior_deviation[k] == 0) side[k] = options.prior_mean[k];
    bumps_.assign(static_cast<std::size_t>(layout_.bumps), 0);
    const auto rows = static_cast<std::size_t>(data.rows);
    for (const ImageEdge& e : data.edges) {
      places_.emplace_back(rows, e.place_nm);
      raw_.emplace_back(rows, e.place_nm);
      errors_.emplace_back(rows, 0.0);
    }
    std::vector<int> seen(data.edges.size(), 0);
    for (const ProfileSample& s : data.samples) ++seen[static_cast<std::size_t>(s.edge)];
    if (data.edges.empty() || std::ranges::any_of(seen, [](int n) { return n < 16; }))
      throw InvalidInput("SEM image", "an edge has fewer than 16 pixels", "Give a larger image");
    width_now();
    begin();
  }

  ProfileFit run() {
    bool converged = false;
    for (int round = 0; round < most_rounds && !converged; ++round) {
      options_.watch.report(round, most_rounds);
      const std::vector<double> before = means();
      const auto numbers_before = numbers_;
      for (int step = 0; step < steps_per_round; ++step) {
        options_.watch.check();
        if (!improve()) break;
      }
      place_rows();
      FollowedRows followed = follow_rows(raw_, errors_, data_.closed, data_.row_distance_nm);
      places_ = std::move(followed.places_nm);
      blur2_ = followed.blur_nm2;
      estimate_noise();
      double moved = 0;
      const std::vector<double> now = means();
      for (std::size_t e = 0; e < now.size(); ++e)
        moved = std::max(moved, std::abs(now[e] - before[e]));
      for (std::size_t k = 0; k < profile_numbers; ++k)
        for (int side = 0; side < 2; ++side)
          if (library_.box().half[k] > 0)
            moved = std::max(moved, std::abs(numbers_[side][k] - numbers_before[side][k]));
      converged = round > 1 && moved < settled_nm;
    }
    for (int step = 0; step < steps_per_round; ++step) {
      options_.watch.check();
      improve();
    }
    return result(converged);
  }

 private:
  bool one_side_only() const {
    return std::ranges::all_of(data_.edges, [&](const ImageEdge& e) {
      return e.material_right == data_.edges.front().material_right;
    });
  }
  static int side_of(const ImageEdge& e) { return e.material_right ? 0 : 1; }
  static double sign_of(const ImageEdge& e) { return e.material_right ? 1 : -1; }

  std::vector<double> means() const {
    std::vector<double> out;
    for (const auto& rows : places_) {
      double sum = 0;
      for (const double x : rows) sum += x / static_cast<double>(rows.size());
      out.push_back(sum);
    }
    return out;
  }

  /// Pairs of edges of one feature.
  template <class Pair>
  void for_each_pair(const Pair& pair) const {
    for (std::size_t e = 0; e + 1 < data_.edges.size(); ++e)
      if (data_.edges[e].feature == data_.edges[e + 1].feature) pair(e, e + 1);
  }

  void width_now() {
    const std::vector<double> mean = means();
    double sum = 0, count = 0;
    for_each_pair([&](std::size_t a, std::size_t b) { sum += mean[b] - mean[a], ++count; });
    if (count == 0 && library_.box().half[profile_width] > 0) sum = 2 * mean.front(), count = 1;
    if (count == 0) return;
    for (auto& side : numbers_) side[profile_width] = clamped(profile_width, sum / count);
    width_beyond_ = numbers_[0][profile_width] != sum / count;
  }

  double clamped(std::size_t k, double value) const {
    const ProfileBox& b = library_.box();
    const double room = beyond_box * b.half[k];
    value = std::clamp(value, b.middle[k] - room, b.middle[k] + room);
    return k == profile_top || k == profile_foot ? std::max(value, 0.0) : value;
  }

  double u_of(const ProfileSample& s) const {
    const auto e = static_cast<std::size_t>(s.edge);
    return sign_of(data_.edges[e]) * (s.x_nm - places_[e][static_cast<std::size_t>(s.row)]);
  }

  struct Bump {
    int first;
    double weights[2];
  };
  Bump bump_at(double u) const {
    const double at = std::clamp((u - library_.first_u_nm()) / options_.model_error_nm, 0.0,
                                 static_cast<double>(layout_.bumps - 1) - 1e-9);
    const int first = static_cast<int>(at);
    return {first, {1 - (at - first), at - first}};
  }
  double bumps_at(double u) const {
    const Bump b = bump_at(u);
    return b.weights[0] * bumps_[static_cast<std::size_t>(b.first)] +
           b.weights[1] * bumps_[static_cast<std::size_t>(b.first) + 1];
  }

  double signal(const ProfileLibrary::Value& v) const { return v.value + 0.5 * blur2_ * v.by_u2; }
  double model(const ProfileLibrary::Value& v, double u) const {
    return gain_ * signal(v) + offset_ + bumps_at(u);
  }

  double variance_of(double level) const {
    return std::max(noise_[0] + noise_[1] * level, least_variance_);
  }

  /// All edges, away from their material.
  void move_outward(double by_nm) {
    for (std::size_t e = 0; e < places_.size(); ++e) {
      for (double& x : places_[e]) x -= sign_of(data_.edges[e]) * by_nm;
      for (double& x : raw_[e]) x -= sign_of(data_.edges[e]) * by_nm;
    }
    width_now();
  }

  /// Gain and offset by least squares, where edges lie best: thresholds are off by nanometres, and
  /// chance in the library makes small valleys in between, in which steps would end.
  void begin() {
    constexpr double farthest_nm = 6, step_nm = 0.25;
    double best = 0, least = HUGE_VAL;
    for (double at = -farthest_nm; at <= farthest_nm; at += step_nm) {
      move_outward(at);
      const double left = scale();
      move_outward(-at);
      if (left < least) least = left, best = at;
    }
    move_outward(best);
    scale();
  }

  /// Sets gain and offset, and returns the mean squared residual.
  double scale() {
    double n = 0, s = 0, y = 0, ss = 0, sy = 0, yy = 0;
    for (const ProfileSample& p : data_.samples) {
      const ImageEdge& e = data_.edges[static_cast<std::size_t>(p.edge)];
      const double v = library_.at(u_of(p), numbers_[side_of(e)]).value;
      ++n, s += v, y += p.value, ss += v * v, sy += v * p.value, yy += p.value * p.value;
    }
    const double spread = ss - s * s / n, both = sy - s * y / n, own = yy - y * y / n;
    gain_ = spread > 0 ? std::max(1e-12, both / spread) : 1;
    offset_ = (y - gain_ * s) / n;
    noise_ = {std::max(1e-12, own / n) * 0.25, 0};
    least_variance_ = 1e-6 * noise_[0];
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (double u = library_.first_u_nm(); u <= library_.last_u_nm(); u += 1) {
      const double v = library_.at(u, numbers_[0]).value;
      low = std::min(low, v), high = std::max(high, v);
    }
    contrast_ = high - low;
    return (own - 2 * gain_ * both + gain_ * gain_ * spread) / n;
  }

  struct Normal {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd pull;  // minus the gradient
    double value = 0;
  };

  /// The negative logarithm of the posterior, and its Gauss-Newton equations; those that errors are
  /// taken from have slopes over some places.
  Normal normal(bool of_errors = false) const {
    const int n = layout_.all();
    Normal out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0};
    Derivatives d;
    for (const ProfileSample& s : data_.samples) {
      const ImageEdge& e = data_.edges[static_cast<std::size_t>(s.edge)];
      const int side = side_of(e);
      const double u = u_of(s);
      const ProfileLibrary::Value v = library_.at(u, numbers_[side]);
      const double m = model(v, u), variance = variance_of(m), off = s.value - m;
      derivatives(s, u, v, of_errors ? slope_around(u, side) : v.by_u, d);
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
    for (int side = 0; side < layout_.walls; ++side)
      for (std::size_t k = 0; k < layout_.free.size(); ++k) {
        const std::size_t number = layout_.free[k];
        const double deviation = options_.prior_deviation[number];
        if (std::isfinite(deviation))
          prior(layout_.wall(side) + static_cast<int>(k),
                numbers_[side][number] - options_.prior_mean[number], deviation);
      }
    for (int k = 0; k < layout_.bumps; ++k)
      prior(layout_.bump(k), bumps_[static_cast<std::size_t>(k)], bump_deviation());
    return out;
  }

  /// The signal's slope over some places: that between two alone is half chance, which would look
  /// like something that tells where the edge is.
  double slope_around(double u, int side) const {
    const double reach = std::max(2 * library_.step_nm(), 2.0);
    return (library_.at(u + reach, numbers_[side]).value -
            library_.at(u - reach, numbers_[side]).value) /
           (2 * reach);
  }

  /// Derivatives of the model at a sample, by number of the fit.
  using Derivatives = std::vector<std::pair<int, double>>;
  void derivatives(const ProfileSample& s, double u, const ProfileLibrary::Value& v, double slope,
                   Derivatives& d) const {
    const ImageEdge& e = data_.edges[static_cast<std::size_t>(s.edge)];
    d.clear();
    d.emplace_back(0, signal(v) * gain_);  // of the gain's logarithm
    d.emplace_back(1, 1);
    for (std::size_t k = 0; k < layout_.free.size(); ++k)
      d.emplace_back(layout_.wall(side_of(e)) + static_cast<int>(k),
                     gain_ * v.by_number[layout_.free[k]]);
    d.emplace_back(layout_.edge(s.edge), -sign_of(e) * gain_ * slope);
    const Bump b = bump_at(u);
    d.emplace_back(layout_.bump(b.first), b.weights[0]);
    d.emplace_back(layout_.bump(b.first + 1), b.weights[1]);
  }

  /// The covariance, and what the library's own errors move the fit by: all rows share them, and
  /// chance in neighbouring places looks like a slope that tells where an edge is.
  Eigen::MatrixXd with_library_errors(const Eigen::MatrixXd& covariance) const {
    const std::vector<double>& variances = library_.variances();
    Eigen::MatrixXd pull =
        Eigen::MatrixXd::Zero(layout_.all(), static_cast<Eigen::Index>(variances.size()));
    Derivatives d;
    for (const ProfileSample& s : data_.samples) {
      const double u = u_of(s);
      const ProfileLibrary::Value v =
          library_.at(u, numbers_[side_of(data_.edges[static_cast<std::size_t>(s.edge)])]);
      const double variance = variance_of(model(v, u));
      derivatives(s, u, v, slope_around(u, side_of(data_.edges[static_cast<std::size_t>(s.edge)])),
                  d);
      for (std::size_t i = 0; i < v.places.size(); ++i)
        for (const auto& [number, by_number] : d)
          pull(number, static_cast<Eigen::Index>(v.places[i])) +=
              by_number * gain_ * v.weights[i] / variance;
    }
    for (std::size_t k = 0; k < variances.size(); ++k)
      pull.col(static_cast<Eigen::Index>(k)) *= std::sqrt(variances[k]);
    const Eigen::MatrixXd moved = covariance * pull;
    return covariance + moved * moved.transpose();
  }

  double bump_deviation() const {
    constexpr double least = 1e-6;  // a prior of no width has no inverse
    return gain_ * std::max(options_.model_error, least) * contrast_;
  }

  void move(const Eigen::VectorXd& step) {
    gain_ *= std::exp(std::clamp(step(0), -0.5, 0.5));
    offset_ += step(1);
    for (int side = 0; side < layout_.walls; ++side)
      for (std::size_t k = 0; k < layout_.free.size(); ++k) {
        const std::size_t number = layout_.free[k];
        numbers_[side][number] = clamped(
            number, numbers_[side][number] + step(layout_.wall(side) + static_cast<int>(k)));
      }
    if (layout_.walls == 1) numbers_[1] = numbers_[0];
    for (std::size_t e = 0; e < places_.size(); ++e) {
      const double by = std::clamp(step(layout_.edge(static_cast<int>(e))), -20.0, 20.0);
      for (double& x : places_[e]) x += by;
      for (double& x : raw_[e]) x += by;
    }
    for (int k = 0; k < layout_.bumps; ++k)
      bumps_[static_cast<std::size_t>(k)] += step(layout_.bump(k));
    width_now();
  }

  /// One Gauss-Newton step, shortened until it lowers the objective.
  bool improve() {
    const Normal now = normal();
    const Eigen::VectorXd step = now.matrix.ldlt().solve(now.pull);
    const Fit before = *this;
    for (double share = 1; share > 1e-3; share *= 0.3) {
      move(share * step);
      if (normal().value < now.value + 1e-9 * std::abs(now.value)) return step.norm() > 1e-6;
      take(before);
    }
    return false;
  }

  void take(const Fit& other) {
    numbers_ = other.numbers_, gain_ = other.gain_, offset_ = other.offset_;
    bumps_ = other.bumps_, places_ = other.places_, raw_ = other.raw_;
  }

  /// The place of each edge in each row, by its pixels alone.
  void place_rows() {
    raw_ = places_;
    for (int step = 0; step < row_steps; ++step) {
      std::vector<std::vector<double>> pull, weight;
      for (const auto& rows : raw_) {
        pull.emplace_back(rows.size(), 0.0);
        weight.emplace_back(rows.size(), 0.0);
      }
      for (const ProfileSample& s : data_.samples) {
        const auto e = static_cast<std::size_t>(s.edge), r = static_cast<std::size_t>(s.row);
        const ImageEdge& edge = data_.edges[e];
        const double u = sign_of(edge) * (s.x_nm - raw_[e][r]);
        const ProfileLibrary::Value v = library_.at(u, numbers_[side_of(edge)]);
        const double m = model(v, u), variance = variance_of(m),
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

  /// A line of squared residuals against the level.
  void estimate_noise() {
    double n = 0, m1 = 0, m2 = 0, r1 = 0, mr = 0;
    for (const ProfileSample& s : data_.samples) {
      const double u = u_of(s);
      const double m = model(
          library_.at(u, numbers_[side_of(data_.edges[static_cast<std::size_t>(s.edge)])]), u);
      const double r = (s.value - m) * (s.value - m);
      ++n, m1 += m, m2 += m * m, r1 += r, mr += m * r;
    }
    const double spread = m2 - m1 * m1 / n, slope = spread > 0 ? (mr - m1 * r1 / n) / spread : 0,
                 mean = r1 / n;
    least_variance_ = 0.1 * mean + std::numeric_limits<double>::min();
    noise_ = slope > 0 ? std::array{mean - slope * m1 / n, slope} : std::array{mean, 0.0};
  }

  ProfileFit result(bool converged) {
    ProfileFit out;
    out.converged = converged;
    out.at_border = width_beyond_;
    out.gain = gain_, out.offset = offset_, out.blur_nm = std::sqrt(blur2_);
    const Normal now = normal(true);
    const Eigen::MatrixXd covariance = with_library_errors(
        now.matrix.ldlt().solve(Eigen::MatrixXd::Identity(layout_.all(), layout_.all())));
    const auto error = [&](int i) { return std::sqrt(std::max(covariance(i, i), 0.0)); };
    const ProfileBox& box = library_.box();
    for (int side = 0; side < 2; ++side) {
      auto& wall = side == 0 ? out.left : out.right;
      for (std::size_t k = 0; k < profile_numbers; ++k) {
        wall[k].value = numbers_[side][k];
        const auto at = std::ranges::find(layout_.free, k);
        if (at == layout_.free.end()) continue;
        wall[k].standard_error =
            error(layout_.wall(side) + static_cast<int>(at - layout_.free.begin()));
        // What is known beforehand may lie there: the library's box is its prior's.
        if (std::isfinite(options_.prior_deviation[k])) continue;
        out.at_border = out.at_border || std::abs(numbers_[side][k] - box.middle[k]) >
                                             beyond_box * box.half[k] - 1e-9;
      }
    }
    place_rows();
    const std::vector<double> mean = means();
    for (std::size_t e = 0; e < data_.edges.size(); ++e)
      out.edges.push_back({data_.edges[e],
                           {mean[e], error(layout_.edge(static_cast<int>(e)))},
                           raw_[e],
                           errors_[e]});
    add_widths(covariance, mean, out);
    add_roughness(out);
    add_profiles(out);
    double squares = 0;
    for (const double b : bumps_) squares += b * b / static_cast<double>(bumps_.size());
    out.discrepancy_share = std::sqrt(squares) / (gain_ * contrast_);
    return out;
  }

  void add_widths(const Eigen::MatrixXd& covariance, const std::vector<double>& mean,
                  ProfileFit& out) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(layout_.all());
    for_each_pair([&](std::size_t a, std::size_t b) {
      Eigen::VectorXd of = Eigen::VectorXd::Zero(layout_.all());
      of(layout_.edge(static_cast<int>(a))) = -1;
      of(layout_.edge(static_cast<int>(b))) = 1;
      out.widths_nm.push_back({mean[b] - mean[a], std::sqrt(of.dot(covariance * of))});
      all += of;
    });
    if (out.widths_nm.empty() && library_.box().half[profile_width] > 0) {
      all(layout_.edge(0)) = 2;
      out.widths_nm.push_back({2 * mean[0], std::sqrt(all.dot(covariance * all))});
    }
    if (out.widths_nm.empty()) return;
    all /= static_cast<double>(out.widths_nm.size());
    double width = 0;
    for (const Measured& w : out.widths_nm)
      width += w.value / static_cast<double>(out.widths_nm.size());
    out.left[profile_width] =
        out.right[profile_width] = {width, std::sqrt(all.dot(covariance * all))};
  }

  void add_roughness(ProfileFit& out) const {
    const double distance = data_.row_distance_nm;
    if (static_cast<std::size_t>(data_.rows) < fewest_rows_with_spectrum) return;
    out.edge_spectrum = surf::edge_spectrum(without_middle(raw_, data_.closed), distance);
    out.edge_roughness = fit_roughness(out.edge_spectrum, layout_.edges, distance);
    std::vector<std::vector<double>> widths;
    for_each_pair([&](std::size_t a, std::size_t b) {
      widths.push_back(raw_[b]);
      for (std::size_t r = 0; r < widths.back().size(); ++r) widths.back()[r] -= raw_[a][r];
    });
    if (widths.empty()) return;
    out.width_spectrum = surf::edge_spectrum(widths, distance);
    out.width_roughness =
        fit_roughness(out.width_spectrum, static_cast<int>(widths.size()), distance);
  }

  void add_profiles(ProfileFit& out) const {
    constexpr double step = 1;
    const int bins = 1 + static_cast<int>((library_.last_u_nm() - library_.first_u_nm()) / step);
    for (int side = 0; side < 2; ++side) {
      std::vector<double> sum(static_cast<std::size_t>(bins), 0), at = sum, variance = sum,
                                                                  count = sum, fitted = sum;
      for (const ProfileSample& s : data_.samples) {
        const ImageEdge& e = data_.edges[static_cast<std::size_t>(s.edge)];
        if (side_of(e) != side) continue;
        const double u = u_of(s);
        const int bin = static_cast<int>(std::floor((u - library_.first_u_nm()) / step));
        if (bin < 0 || bin >= bins) continue;
        const auto b = static_cast<std::size_t>(bin);
        const double m = model(library_.at(u, numbers_[side]), u);
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
      if (!p.u_nm.empty()) out.profiles.push_back(std::move(p));
    }
  }

  const ProfileData& data_;
  const ProfileLibrary& library_;
  const ProfileFitOptions& options_;
  Layout layout_;
  std::array<ProfileNumbers, 2> numbers_{};  // of left and right walls
  double gain_ = 1, offset_ = 0, blur2_ = 0, contrast_ = 1;
  bool width_beyond_ = false;      // of the library's box
  std::array<double, 2> noise_{};  // variance at level 0, and per level
  double least_variance_ = 0;
  std::vector<double> bumps_;
  std::vector<std::vector<double>> places_, raw_, errors_;  // of each edge, by row
};

}  // namespace

ProfileFit fit_profile(const ProfileData& data, const ProfileLibrary& library,
                       const ProfileFitOptions& options) {
  return Fit(data, library, options).run();
}

}  // namespace surf
