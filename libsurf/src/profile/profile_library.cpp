// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/profile_library.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

double halton(std::size_t index, int base) {
  double value = 0, digit = 1;
  for (std::size_t i = index; i > 0; i /= static_cast<std::size_t>(base)) {
    digit /= base;
    value += digit * static_cast<double>(i % static_cast<std::size_t>(base));
  }
  return value;
}

std::vector<std::size_t> free_numbers(const ProfileBox& box) {
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < profile_numbers; ++k)
    if (box.half[k] > 0) free.push_back(k);
  return free;
}

std::size_t terms_of(std::size_t free) { return 1 + free + free * (free + 1) / 2; }

/// Weights of four neighbours for a cubic between the middle two, and their derivatives
/// (Catmull and Rom).
struct Cubic {
  std::array<double, 4> value, slope, bend;

  explicit Cubic(double t) {
    const double t2 = t * t, t3 = t2 * t;
    value = {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t,
             0.5 * t3 - 0.5 * t2};
    slope = {-1.5 * t2 + 2 * t - 0.5, 4.5 * t2 - 5 * t, -4.5 * t2 + 4 * t + 0.5, 1.5 * t2 - t};
    bend = {-3 * t + 2, 9 * t - 5, -9 * t + 4, 3 * t - 1};
  }
};

/// A number's effect on the signal counts as far as it is more than chance around (Wiener): chance
/// in each place would look like something that the image tells.
void keep_what_shows(Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> effect,
                     const Eigen::RowVectorXd& variance) {
  constexpr int reach = 4;
  Eigen::RowVectorXd kept = effect;
  for (Eigen::Index u = 0; u < effect.size(); ++u) {
    const Eigen::Index from = std::max<Eigen::Index>(0, u - reach),
                       count = std::min<Eigen::Index>(effect.size(), u + reach + 1) - from;
    const double seen = effect.segment(from, count).squaredNorm(),
                 chance = variance.segment(from, count).sum();
    kept(u) *= seen > 0 ? std::max(0.0, 1 - chance / seen) : 0;
  }
  effect = kept;
}

}  // namespace

std::vector<double> blur_weights(double deviation) {
  constexpr double farthest = 4;
  std::vector<double> out{1};
  double sum = 1;
  for (int k = 1; k <= std::ceil(farthest * deviation); ++k) {
    out.push_back(std::exp(-0.5 * std::pow(k / deviation, 2)));
    sum += 2 * out.back();
  }
  for (double& w : out) w /= sum;
  return out;
}

std::vector<ProfileNumbers> profile_design(const ProfileBox& box, double per_term) {
  constexpr std::array<int, profile_numbers> bases{2, 3, 5, 7, 11};
  const std::vector<std::size_t> free = free_numbers(box);
  const auto count =
      static_cast<std::size_t>(std::ceil(per_term * static_cast<double>(terms_of(free.size()))));
  std::vector<ProfileNumbers> out{box.middle};
  for (std::size_t i = 1; i < std::max<std::size_t>(count, 1); ++i) {
    ProfileNumbers p = box.middle;
    for (std::size_t k = 0; k < free.size(); ++k)
      p[free[k]] += box.half[free[k]] * (2 * halton(i, bases[k]) - 1);
    out.push_back(p);
  }
  return out;
}

ProfileLibrary::ProfileLibrary(ProfileBox box, double first_u_nm, double step_nm,
                               const std::vector<ProfileNumbers>& shapes,
                               const std::vector<std::vector<double>>& signals,
                               const FinerMiddle& middle, double blurred_by_nm)
    : box_(box), first_(first_u_nm), step_(step_nm), free_(free_numbers(box)),
      blur_(blur_weights(blurred_by_nm / step_nm)) {
  terms_ = terms_of(free_.size());
  if (shapes.size() != signals.size() || shapes.size() < terms_)
    throw InvalidInput("profiles", "there are fewer shapes than terms", "Simulate more");
  count_ = signals.front().size();
  if (count_ < 4 || !(step_nm > 0))
    throw InvalidInput("profiles", "a signal has fewer than four places", "Give a finer step");
  const auto rows = static_cast<Eigen::Index>(shapes.size());
  Eigen::MatrixXd design(rows, static_cast<Eigen::Index>(terms_)),
      values(rows, static_cast<Eigen::Index>(count_));
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::vector<Term> t = terms(shapes[i]);
    for (std::size_t k = 0; k < terms_; ++k)
      design(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = t[k].value;
    if (signals[i].size() != count_)
      throw InvalidInput("profiles", "signals have different lengths", "Give the same places");
    for (std::size_t u = 0; u < count_; ++u) {
      if (!std::isfinite(signals[i][u]))
        throw InvalidInput("profiles", "a signal is not finite", "Simulate it again");
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(u)) = signals[i][u];
    }
  }
  const bool finer = !middle.signal.empty();
  if (finer && (middle.signal.size() != count_ || middle.variance.size() != count_))
    throw InvalidInput("profiles", "the finer middle has another length", "Give the same places");
  const auto solver = design.colPivHouseholderQr();
  Eigen::MatrixXd fit = solver.solve(values);
  const Eigen::MatrixXd left = values - design * fit;
  const double freedom = std::max<double>(1, static_cast<double>(shapes.size() - terms_)),
               fitted = static_cast<double>(finer ? terms_ - 1 : terms_);
  const Eigen::VectorXd noise = left.colwise().squaredNorm().transpose() / freedom;
  const Eigen::MatrixXd inverse =
      (design.transpose() * design)
          .ldlt()
          .solve(Eigen::MatrixXd::Identity(design.cols(), design.cols()));
  for (Eigen::Index k = 1; k < fit.rows(); ++k)
    keep_what_shows(fit.row(k), noise.transpose() * inverse(k, k));
  double squares = 0;
  for (std::size_t k = 0; k < blur_.size(); ++k) squares += (k == 0 ? 1 : 2) * blur_[k] * blur_[k];
  for (std::size_t u = 0; u < count_; ++u) {
    const auto column = static_cast<Eigen::Index>(u);
    if (finer) fit(0, column) = middle.signal[u];
    for (std::size_t k = 0; k < terms_; ++k)
      coefficients_.push_back(fit(static_cast<Eigen::Index>(k), column));
    variance_.push_back((noise(column) * fitted / static_cast<double>(shapes.size()) +
                         (finer ? middle.variance[u] : 0)) /
                        squares);
  }
}

std::vector<ProfileLibrary::Term> ProfileLibrary::terms(const ProfileNumbers& numbers) const {
  std::vector<Term> out{{1, {}}};
  std::array<double, profile_numbers> t{};
  for (const std::size_t k : free_) {
    t[k] = (numbers[k] - box_.middle[k]) / box_.half[k];
    Term linear{t[k], {}};
    linear.by_number[k] = 1 / box_.half[k];
    out.push_back(linear);
  }
  for (std::size_t i = 0; i < free_.size(); ++i)
    for (std::size_t j = i; j < free_.size(); ++j) {
      const std::size_t a = free_[i], b = free_[j];
      Term product{t[a] * t[b], {}};
      product.by_number[a] += t[b] / box_.half[a];
      product.by_number[b] += t[a] / box_.half[b];
      out.push_back(product);
    }
  return out;
}

ProfileLibrary::Value ProfileLibrary::at(double u_nm, const ProfileNumbers& numbers) const {
  const double last = static_cast<double>(count_ - 1), wanted = (u_nm - first_) / step_,
               place = std::clamp(wanted, 0.0, last);
  const auto before = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
  const Cubic cubic(place - static_cast<double>(before));
  const std::vector<Term> t = terms(numbers);
  const bool inside = wanted > 0 && wanted < last;
  Value out;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t u = std::min(before + i > 0 ? before + i - 1 : 0, count_ - 1);
    const double* c = &coefficients_[u * terms_];
    double value = 0;
    for (std::size_t k = 0; k < terms_; ++k) {
      value += c[k] * t[k].value;
      for (const std::size_t n : free_)
        out.by_number[n] += cubic.value[i] * c[k] * t[k].by_number[n];
    }
    out.value += cubic.value[i] * value;
    out.places[i] = u, out.weights[i] = cubic.value[i];
    if (inside) {
      out.by_u += cubic.slope[i] * value / step_;
      out.by_u2 += cubic.bend[i] * value / (step_ * step_);
    }
  }
  return out;
}

}  // namespace surf
