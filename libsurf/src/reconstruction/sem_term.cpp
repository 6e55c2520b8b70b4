// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_term.h"

#include <cmath>
#include <numbers>

#include "afm/normal_numbers.h"
#include "gaussian_basis.h"
#include "spot_blur.h"
#include "surf/sem/film_model.h"

namespace surf::reconstruction {
namespace {

constexpr double soft_px = 1.5;  // over which grey levels are averaged to tell their noise

}  // namespace

SemTerm::SemTerm(const SemData& data, const SurfaceFrame& frame, int left, int below, int threads)
    : model_(data.model), film_(data.film.has_value()), frame_(frame), noise_(data.noise),
      channels_(data.model->channels().size()), image_(frame.width, frame.height),
      used_(frame.width, frame.height) {
  if (film_) model_ = std::make_shared<FilmModel>(data.model, *data.film);
  options_.threads = threads;
  for (int y = 0; y < data.image.values.height(); ++y)
    for (int x = 0; x < data.image.values.width(); ++x) {
      if (!data.image.is_valid(x, y)) continue;
      image_(x + left, y + below) = data.image.values(x, y);
      used_(x + left, y + below) = 1;
      ++used_pixels_;
    }
  if (data.discrepancy.empty() && data.row_jitter.empty()) return;
  const auto placed = [&](const Grid<double>& given) {
    Grid<double> out(frame.width, frame.height);
    for (int y = 0; y < given.height(); ++y)
      for (int x = 0; x < given.width(); ++x) out(x + left, y + below) = given(x, y);
    return out;
  };
  for (const SemDiscrepancy& given : data.discrepancy)
    parts_.push_back({placed(given.deviation), given.correlation_px});
  if (!data.row_jitter.empty()) row_jitter_ = placed(data.row_jitter);
  // By the image itself, so that one factor does for all surfaces.
  const Grid<double> soft = GaussianBasis(soft_px, threads).sum(image_);
  weight_ = Grid<double>(frame.width, frame.height);
  for (std::size_t i = 0; i < weight_.size(); ++i)
    if (used_.data()[i]) weight_.data()[i] = 1 / noise_.variance(soft.data()[i]);
  factor_ = Discrepancy(parts_, row_jitter_).factor(weight_);
}

void SemTerm::follow(std::vector<Grid<double>> fields, double deviation) {
  if (!factor_) return;
  for (Grid<double>& field : fields)
    for (double& v : field.data()) v *= deviation;
  factor_ = Discrepancy(parts_, row_jitter_, fields).factor(weight_);
}

std::vector<double> SemTerm::gains_of(const Mixture& mixture) const {
  std::vector<double> gains = mixture.gains;
  for (std::size_t c = 0; c < channels_ && film_; ++c)
    gains.push_back(mixture.film_nm * mixture.gains[c]);
  return gains;
}

Grid<double> SemTerm::mixed(const ModelImages& images, const std::vector<double>& gains) const {
  Grid<double> out(frame_.width, frame_.height);
  for (std::size_t c = 0; c < gains.size(); ++c)
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += gains[c] * images[c].data()[i];
  return out;
}

Grid<double> SemTerm::change_by_film(const State& s, const Mixture& mixture) const {
  std::vector<double> gains(channels_);
  if (film_) gains.insert(gains.end(), mixture.gains.begin(), mixture.gains.end());
  return mixed(s.linear->images(), gains);
}

SemTerm::State SemTerm::evaluate(const Grid<double>& z, const Mixture& mixture) const {
  State s;
  s.linear = model_->linearize(frame_.field(z), options_);
  s.sharp = mixed(s.linear->images(), gains_of(mixture));
  s.simulated = blurred(s.sharp, mixture.blur_px2);
  for (double& v : s.simulated.data()) v += mixture.offset;
  if (!factor_) {
    s.value = -log_likelihood(image_, s.simulated, noise_, used_, &s.pull, &s.information);
    for (double& p : s.pull.data()) p = -p;
    return s;
  }
  Grid<double> residual(frame_.width, frame_.height), explained = image_, left = residual;
  for (std::size_t i = 0; i < residual.size(); ++i)
    if (used_.data()[i]) residual.data()[i] = image_.data()[i] - s.simulated.data()[i];
  Discrepancy::Factor::Fit fit = factor_->fit(residual);
  for (std::size_t i = 0; i < explained.size(); ++i) explained.data()[i] -= fit.field.data()[i];
  s.value =
      fit.penalty - log_likelihood(explained, s.simulated, noise_, used_, &s.pull, &s.information);
  for (double& p : s.pull.data()) p = -p;
  for (std::size_t i = 0; i < left.size(); ++i)
    if (used_.data()[i])
      left.data()[i] =
          (residual.data()[i] - fit.field.data()[i]) / noise_.variance(s.simulated.data()[i]);
  // The fit follows the simulated pixels.
  const Grid<double> through = factor_->spread(left, fit);
  for (std::size_t i = 0; i < through.size(); ++i) s.pull.data()[i] += through.data()[i];
  s.row_jitter = factor_->rows_of(fit);
  s.discrepancy = std::move(fit.field);
  return s;
}

void SemTerm::add_gradient(const State& s, const Mixture& mixture, const Grid<double>& weights,
                           const Near* near, Grid<double>& out, MixtureChange* by_mixture) const {
  if (near) {
    for (int y = 0; y < frame_.height; ++y)
      for (int x = 0; x < frame_.width; ++x) near->scatter(weights(x, y), x, y, out);
  } else {
    const Grid<double> sharp = blurred(weights, mixture.blur_px2);  // the blur is symmetric
    ModelImages w;
    for (const double gain : gains_of(mixture)) {
      w.push_back(sharp);
      for (double& v : w.back().data()) v *= gain;
    }
    const Grid<double> gradient = s.linear->gradient(w);
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += gradient.data()[i];
  }
  if (!by_mixture) return;
  const auto images = mixture_images(s, mixture);
  for (int k = 0; k < mixture_numbers; ++k)
    for (std::size_t i = 0; i < out.size(); ++i)
      (*by_mixture)[k] += weights.data()[i] * images[k].data()[i];
}

std::array<Grid<double>, mixture_numbers> SemTerm::mixture_images(const State& s,
                                                                  const Mixture& mixture) const {
  Grid<double> by_gain = s.simulated;
  for (double& v : by_gain.data()) v -= mixture.offset;
  return {std::move(by_gain), Grid<double>(frame_.width, frame_.height, 1.0),
          change_of_blur(s.sharp, mixture.blur_px2),
          film_ ? blurred(change_by_film(s, mixture), mixture.blur_px2)
                : Grid<double>(frame_.width, frame_.height)};
}

Grid<double> SemTerm::change(const State& s, const Mixture& mixture, const Grid<double>& dz,
                             const MixtureChange& mixture_change, const Near* near) const {
  Grid<double> out(frame_.width, frame_.height);
  if (near) {
    for (int y = 0; y < frame_.height; ++y)
      for (int x = 0; x < frame_.width; ++x) out(x, y) += near->change(dz, x, y);
  } else {
    out = blurred(mixed(s.linear->change(dz), gains_of(mixture)), mixture.blur_px2);
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] +=
        mixture_change[0] * (s.simulated.data()[i] - mixture.offset) + mixture_change[1];
  const auto add = [&](double factor, const Grid<double>& image) {
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += factor * image.data()[i];
  };
  if (mixture_change[2] != 0) add(mixture_change[2], change_of_blur(s.sharp, mixture.blur_px2));
  if (film_ && mixture_change[3] != 0)
    add(mixture_change[3], blurred(change_by_film(s, mixture), mixture.blur_px2));
  return out;
}

Grid<double> SemTerm::precision(const State& s, const Grid<double>& change) const {
  if (factor_) return factor_->precision(change);
  Grid<double> out = change;
  for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] *= s.information.data()[i];
  return out;
}

std::array<std::array<double, mixture_numbers>, mixture_numbers> SemTerm::mixture_precision(
    const State& s, const Mixture& mixture) const {
  std::array<std::array<double, mixture_numbers>, mixture_numbers> out{};
  const auto images = mixture_images(s, mixture);
  for (int i = 0; i < mixture_numbers; ++i) {
    const Grid<double> weighed = precision(s, images[i]);
    for (int k = 0; k < mixture_numbers; ++k)
      for (std::size_t p = 0; p < weighed.size(); ++p)
        out[i][k] += weighed.data()[p] * images[k].data()[p];
  }
  return out;
}

Grid<double> SemTerm::draw_precision(const State& s, std::uint64_t seed) const {
  NormalNumbers normal(seed, 1);
  Grid<double> w(frame_.width, frame_.height);
  for (std::size_t i = 0; i < w.size(); ++i)
    w.data()[i] = std::sqrt(s.information.data()[i]) * normal();
  if (!factor_) return w;
  const Grid<double> field = factor_->draw(seed, 4);
  for (std::size_t i = 0; i < w.size(); ++i)
    w.data()[i] =
        s.information.data()[i] > 0 ? w.data()[i] / s.information.data()[i] + field.data()[i] : 0;
  return factor_->precision(w);
}

SemTerm::Near SemTerm::near(const State& s, const Mixture& mixture) const {
  constexpr double k = 2 * std::numbers::pi / 12;
  const Grid<double> none(frame_.width, frame_.height);
  Near out{none, none, none, none, none};
  for (int axis = 0; axis < 2; ++axis) {
    Grid<double> cosine = none, sine = none;
    for (int y = 0; y < frame_.height; ++y)
      for (int x = 0; x < frame_.width; ++x) {
        cosine(x, y) = std::cos(k * (axis == 0 ? x : y));
        sine(x, y) = std::sin(k * (axis == 0 ? x : y));
      }
    const Grid<double> c = change(s, mixture, cosine, {}), d = change(s, mixture, sine, {});
    Grid<double>&before = axis == 0 ? out.left : out.below,
    &after = axis == 0 ? out.right : out.above;
    for (int y = 1; y + 1 < frame_.height; ++y)
      for (int x = 1; x + 1 < frame_.width; ++x) {
        // J exp(ikx) = exp(ikx) (i sin(k) slope + (2 cos(k) - 2) bend)
        const double p = cosine(x, y), q = sine(x, y);
        const double slope = (p * d(x, y) - q * c(x, y)) / std::sin(k);
        const double bend = (p * c(x, y) + q * d(x, y)) / (2 * std::cos(k) - 2);
        before(x, y) = bend - 0.5 * slope;
        after(x, y) = bend + 0.5 * slope;
        out.own(x, y) -= 2 * bend;
      }
  }
  return out;
}

double SemTerm::Near::change(const Grid<double>& dz, int x, int y) const {
  if (x == 0 || y == 0 || x + 1 == dz.width() || y + 1 == dz.height()) return 0;
  return left(x, y) * dz(x - 1, y) + right(x, y) * dz(x + 1, y) + below(x, y) * dz(x, y - 1) +
         above(x, y) * dz(x, y + 1) + own(x, y) * dz(x, y);
}

void SemTerm::Near::scatter(double weight, int x, int y, Grid<double>& out) const {
  if (x == 0 || y == 0 || x + 1 == out.width() || y + 1 == out.height()) return;
  out(x - 1, y) += weight * left(x, y);
  out(x + 1, y) += weight * right(x, y);
  out(x, y - 1) += weight * below(x, y);
  out(x, y + 1) += weight * above(x, y);
  out(x, y) += weight * own(x, y);
}

}  // namespace surf::reconstruction
