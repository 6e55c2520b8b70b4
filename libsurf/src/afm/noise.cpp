// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/noise.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "afm/normal_numbers.h"
#include "surf/core/error.h"

namespace surf {
namespace {

void validate_residual(const Grid<double>& residual_nm, const Mask& valid) {
  if (!valid.empty() &&
      (valid.width() != residual_nm.width() || valid.height() != residual_nm.height()))
    throw InvalidInput("residual",
                       fmt::format("its mask has {} x {} samples, itself {} x {}", valid.width(),
                                   valid.height(), residual_nm.width(), residual_nm.height()),
                       "Give a mask of the same size, or none");
  for (std::size_t i = 0; i < residual_nm.size(); ++i)
    if (valid.includes(i) && !std::isfinite(residual_nm.data()[i]))
      throw InvalidInput("residual", fmt::format("sample {} is {}", i, residual_nm.data()[i]),
                         "Mark it as invalid");
}

/// Calls `visit(index, previous, carry, variance)` for each valid sample of a row from left to
/// right. `previous` is the index of the last valid sample before it; given that sample's value,
/// the mean is carry times the value. The first sample of a row has carry 0 and the stationary
/// variance.
template <class Visit>
void follow_row(const AfmNoise& noise, const Mask& valid, std::size_t first, int width,
                const Visit& visit) {
  const double stationary = noise.variance_nm2();
  std::size_t previous = first;
  double carry = 0;
  for (std::size_t i = first; i < first + static_cast<std::size_t>(width); ++i) {
    carry *= noise.alpha;
    if (!valid.empty() && !valid.data()[i]) continue;
    const bool next_to_it = i == previous + 1 && carry == noise.alpha;
    visit(i, previous, carry, next_to_it ? noise.innovation_nm2 : stationary * (1 - carry * carry));
    previous = i;
    carry = 1;
  }
}

}  // namespace

void validate(const AfmNoise& noise, const char* subject, bool allow_zero) {
  if (!(std::fabs(noise.alpha) < 1))
    throw InvalidInput(subject, fmt::format("alpha is {:g}", noise.alpha),
                       "It has to be in (-1, 1)");
  const double v = noise.innovation_nm2;
  if (std::isfinite(v) && std::isfinite(noise.variance_nm2()) && (v > 0 || (allow_zero && v == 0)))
    return;
  throw InvalidInput(
      subject, fmt::format("the innovation's variance is {:g} nm^2", v),
      allow_zero ? "Give a finite number, 0 or above" : "Give a finite number above 0");
}

Grid<double> simulate_noise(const AfmNoise& noise, int width, int height, std::uint64_t seed) {
  validate(noise, "noise", true);
  if (width < 1 || height < 1)
    throw UsageError("noise", fmt::format("{} x {} samples are asked for", width, height),
                     "Ask for 1 x 1 at least");
  Grid<double> out(width, height);
  const double first = std::sqrt(noise.variance_nm2());
  const double step = std::sqrt(noise.innovation_nm2);
  for (int y = 0; y < height; ++y) {
    NormalNumbers draw(seed, static_cast<std::uint64_t>(y));
    out(0, y) = first * draw();
    for (int x = 1; x < width; ++x) out(x, y) = noise.alpha * out(x - 1, y) + step * draw();
  }
  return out;
}

Grid<double> whiten(const Grid<double>& residual_nm, const AfmNoise& noise, const Mask& valid) {
  validate(noise);
  validate_residual(residual_nm, valid);
  Grid<double> out(residual_nm.width(), residual_nm.height());
  const std::vector<double>& e = residual_nm.data();
  for (std::size_t first = 0; first < e.size(); first += static_cast<std::size_t>(out.width()))
    follow_row(noise, valid, first, out.width(),
               [&](std::size_t i, std::size_t previous, double carry, double variance) {
                 const double mean = carry == 0 ? 0 : carry * e[previous];
                 out.data()[i] = (e[i] - mean) / std::sqrt(variance);
               });
  return out;
}

double log_likelihood(const Grid<double>& residual_nm, const AfmNoise& noise, const Mask& valid,
                      Grid<double>* gradient) {
  validate(noise);
  validate_residual(residual_nm, valid);
  if (gradient) *gradient = Grid<double>(residual_nm.width(), residual_nm.height());
  const std::vector<double>& e = residual_nm.data();
  const double log_innovation = std::log(2 * std::numbers::pi * noise.innovation_nm2);
  double total = 0;
  for (std::size_t first = 0; first < e.size();
       first += static_cast<std::size_t>(residual_nm.width())) {
    double row = 0;
    follow_row(noise, valid, first, residual_nm.width(),
               [&](std::size_t i, std::size_t previous, double carry, double variance) {
                 const double left = e[i] - (carry == 0 ? 0 : carry * e[previous]);
                 const double pull = left / variance;
                 row -= left * pull + (variance == noise.innovation_nm2
                                           ? log_innovation
                                           : std::log(2 * std::numbers::pi * variance));
                 if (!gradient) return;
                 gradient->data()[i] -= pull;
                 if (carry != 0) gradient->data()[previous] += carry * pull;
               });
    total += row / 2;
  }
  return total;
}

}  // namespace surf
