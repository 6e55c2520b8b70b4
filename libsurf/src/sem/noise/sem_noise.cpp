// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/sem_noise.h"

#include <cmath>
#include <numbers>

#include "surf/core/error.h"

namespace surf {
namespace {

void check_sizes(const Grid<double>& real, const Grid<double>& mean, const Mask& used) {
  const auto differs = [&](const auto& grid) {
    return grid.width() != real.width() || grid.height() != real.height();
  };
  if (real.empty() || differs(mean) || (!used.empty() && differs(used)))
    throw InvalidInput("SEM image", "the image, its mean and the mask differ in size",
                       "Give them pixel on pixel");
}

}  // namespace

// Let v = slope mean + intercept be the line and f the least variance. The variance is f for v
// <= 0, v for v >= 2 f, and f + v^2 / (4 f) in between; the derivatives match at both ends.
double SemNoise::variance(double mean) const {
  const double v = slope * mean + intercept;
  if (v >= 2 * least_variance) return v;
  if (v <= 0) return least_variance;
  return least_variance + v * v / (4 * least_variance);
}

double SemNoise::variance_slope(double mean) const {
  const double v = slope * mean + intercept;
  if (v >= 2 * least_variance) return slope;
  if (v <= 0) return 0;
  return slope * v / (2 * least_variance);
}

void validate(const SemNoise& noise, const char* subject) {
  if (!std::isfinite(noise.slope) || !std::isfinite(noise.intercept) ||
      !std::isfinite(noise.least_variance))
    throw InvalidInput(subject, "one of its numbers is not finite", "Give finite numbers");
  if (!(noise.least_variance > 0))
    throw InvalidInput(subject, "its least variance is not above 0",
                       "Give a variance that no pixel is below");
}

double log_likelihood(const Grid<double>& real, const Grid<double>& mean, const SemNoise& noise,
                      const Mask& used, Grid<double>* gradient, Grid<double>* information) {
  validate(noise);
  check_sizes(real, mean, used);
  if (gradient) *gradient = Grid<double>(real.width(), real.height());
  if (information) *information = Grid<double>(real.width(), real.height());
  double sum = 0;
  for (int y = 0; y < real.height(); ++y) {
    double row = 0;
    for (int x = 0; x < real.width(); ++x) {
      if (!used.empty() && !used(x, y)) continue;
      const double e = real(x, y) - mean(x, y), v = noise.variance(mean(x, y)),
                   dv = noise.variance_slope(mean(x, y));
      if (!std::isfinite(e))
        throw InvalidInput("SEM image", "a pixel that counts is not finite",
                           "Leave it out by the mask");
      row -= 0.5 * (std::log(2 * std::numbers::pi * v) + e * e / v);
      if (gradient) (*gradient)(x, y) = e / v + 0.5 * dv / v * (e * e / v - 1);
      if (information) (*information)(x, y) = 1 / v + 0.5 * (dv / v) * (dv / v);
    }
    sum += row;
  }
  return sum;
}

Grid<double> whiten(const Grid<double>& real, const Grid<double>& mean, const SemNoise& noise,
                    const Mask& used) {
  validate(noise);
  check_sizes(real, mean, used);
  Grid<double> white(real.width(), real.height());
  for (std::size_t i = 0; i < real.size(); ++i)
    if (used.includes(i))
      white.data()[i] =
          (real.data()[i] - mean.data()[i]) / std::sqrt(noise.variance(mean.data()[i]));
  return white;
}

}  // namespace surf
