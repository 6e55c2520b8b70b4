// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_term.h"

#include <cmath>
#include <numbers>

namespace surf::reconstruction {

SemTerm::SemTerm(const SemData& data, const SurfaceFrame& frame, int left, int below, int threads)
    : model_(data.model), frame_(frame), noise_(data.noise),
      channels_(data.model->channels().size()), image_(frame.width, frame.height),
      used_(frame.width, frame.height) {
  options_.threads = threads;
  for (int y = 0; y < data.image.values.height(); ++y)
    for (int x = 0; x < data.image.values.width(); ++x) {
      if (!data.image.is_valid(x, y)) continue;
      image_(x + left, y + below) = data.image.values(x, y);
      used_(x + left, y + below) = 1;
      ++used_pixels_;
    }
}

Grid<double> SemTerm::mixed(const ModelImages& images, const std::vector<double>& mixture) const {
  Grid<double> out(frame_.width, frame_.height, mixture[channels_]);
  for (std::size_t c = 0; c < channels_; ++c)
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += mixture[c] * images[c].data()[i];
  return out;
}

SemTerm::State SemTerm::evaluate(const Grid<double>& z, const std::vector<double>& mixture) const {
  State s;
  s.linear = model_->linearize(frame_.field(z), options_);
  s.simulated = mixed(s.linear->images(), mixture);
  s.value = -log_likelihood(image_, s.simulated, noise_, used_, &s.pull, &s.information);
  for (double& p : s.pull.data()) p = -p;
  return s;
}

void SemTerm::add_gradient(const State& s, const std::vector<double>& mixture,
                           const Grid<double>& weights, const Near* near, Grid<double>& out,
                           MixtureChange* by_mixture) const {
  if (near) {
    for (int y = 0; y < frame_.height; ++y)
      for (int x = 0; x < frame_.width; ++x) near->scatter(weights(x, y), x, y, out);
  } else {
    ModelImages w;
    for (std::size_t c = 0; c < channels_; ++c) {
      w.push_back(weights);
      for (double& v : w.back().data()) v *= mixture[c];
    }
    const Grid<double> gradient = s.linear->gradient(w);
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += gradient.data()[i];
  }
  if (!by_mixture) return;
  for (std::size_t i = 0; i < out.size(); ++i) {
    (*by_mixture)[0] += weights.data()[i] * (s.simulated.data()[i] - mixture[channels_]);
    (*by_mixture)[1] += weights.data()[i];
  }
}

Grid<double> SemTerm::change(const State& s, const std::vector<double>& mixture,
                             const Grid<double>& dz, const MixtureChange& mixture_change,
                             const Near* near) const {
  Grid<double> out(frame_.width, frame_.height, mixture_change[1]);
  if (near) {
    for (int y = 0; y < frame_.height; ++y)
      for (int x = 0; x < frame_.width; ++x) out(x, y) += near->change(dz, x, y);
  } else {
    const ModelImages d = s.linear->change(dz);
    for (std::size_t c = 0; c < channels_; ++c)
      for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += mixture[c] * d[c].data()[i];
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] += mixture_change[0] * (s.simulated.data()[i] - mixture[channels_]);
  return out;
}

SemTerm::Near SemTerm::near(const State& s, const std::vector<double>& mixture) const {
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
