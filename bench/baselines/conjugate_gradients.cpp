// SPDX-License-Identifier: GPL-3.0-or-later
#include "conjugate_gradients.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace surf::bench {
namespace {

using Vector = std::vector<double>;

double dot(const Vector& a, const Vector& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

struct Place {
  Vector at, gradient;
  double value = 0;
};

Place moved(const ValueAndGradient& function, const Place& from, const Vector& along, double step) {
  Place to = from;
  for (std::size_t i = 0; i < along.size(); ++i) to.at[i] += step * along[i];
  to.value = function(to.at, to.gradient);
  return to;
}

/// The place that the secant through two derivatives names, or a nearer one whose value is lower.
bool search(const ValueAndGradient& function, Place& here, const Vector& along, double& step) {
  constexpr int tries = 12;
  constexpr double longest = 4;  // times the first step
  const double slope = dot(here.gradient, along);
  Place trial = moved(function, here, along, step);
  const double there = dot(trial.gradient, along);
  const double secant =
      there > slope ? std::min(step * slope / (slope - there), longest * step) : longest * step;
  Place best = moved(function, here, along, secant);
  double length = secant;
  if (!(best.value < trial.value) && trial.value < here.value)
    best = std::move(trial), length = step;
  for (int i = 0; i < tries && !(best.value < here.value); ++i) {
    length /= 4;
    best = moved(function, here, along, length);
  }
  if (!(best.value < here.value)) return false;
  here = std::move(best);
  step = length;
  return true;
}

}  // namespace

double conjugate_gradients(const ValueAndGradient& function, Vector& at,
                           const ConjugateGradientOptions& options) {
  Place here{at, Vector(at.size()), 0};
  here.value = function(here.at, here.gradient);
  Vector along(at.size());
  const auto downhill = [&] {
    std::ranges::transform(here.gradient, along.begin(), std::negate<>());
  };
  downhill();
  const double steep = std::sqrt(dot(here.gradient, here.gradient));
  double step = steep > 0 ? 0.01 / steep * std::sqrt(static_cast<double>(at.size())) : 0;
  for (int i = 0; i < options.iterations && step > 0; ++i) {
    const Vector before = here.gradient;
    const double was = here.value, squared = dot(before, before);
    if (!(squared > 0)) break;
    if (!search(function, here, along, step)) break;
    double beta = 0;
    for (std::size_t k = 0; k < before.size(); ++k)
      beta += here.gradient[k] * (here.gradient[k] - before[k]) / squared;
    beta = std::max(beta, 0.0);
    for (std::size_t k = 0; k < along.size(); ++k) along[k] = beta * along[k] - here.gradient[k];
    if (dot(along, here.gradient) >= 0) downhill();
    if (was - here.value < options.tolerance * std::abs(was)) break;
  }
  at = std::move(here.at);
  return here.value;
}

}  // namespace surf::bench
