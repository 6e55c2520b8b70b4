// SPDX-License-Identifier: GPL-3.0-or-later
#include "slope_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf {
namespace {

// Ikeuchi's constants (1981; thesis, 2.2.4.1), fitted to secondary electron images.
constexpr double exponential_rate = 1.0, secant_angle = 0.8, mixed_part = 0.5;
constexpr double degree = std::numbers::pi / 180;
const double mixed_end = std::tan(70 * degree);

constexpr double most_yield = 1e12;

void check(const SlopeModelParameters& p, const SlopeChannel& channel) {
  const std::string name = "slope model, channel " + channel.name;
  if (p.form != SlopeForm::table) {
    if (channel.flat_yield > 0 && channel.flat_yield <= most_yield) return;
    throw InvalidInput(name, fmt::format("the yield of a flat surface is {}", channel.flat_yield),
                       "Give a finite number above 0");
  }
  if (channel.yields.size() < 2)
    throw InvalidInput(name, fmt::format("its table has {} yields", channel.yields.size()), "Give two at least");
  if (!(p.table_step_deg > 0 && p.table_step_deg * static_cast<double>(channel.yields.size() - 1) <= 90 + 1e-9))
    throw InvalidInput(name, fmt::format("its table has {} yields in steps of {} degrees", channel.yields.size(),
                                         p.table_step_deg),
                       "Angles go from 0 to 90 degrees at most");
  for (const double yield : channel.yields)
    if (!(std::abs(yield) <= most_yield))
      throw InvalidInput(name, fmt::format("its table holds {}", yield), "All yields must be finite");
}

}  // namespace

SlopeCurve::SlopeCurve(const SlopeModelParameters& p, const SlopeChannel& channel)
    : form_(p.form), flat_yield_(channel.flat_yield), step_rad_(p.table_step_deg * degree),
      yields_(channel.yields) {
  check(p, channel);
}

SlopeCurve::Value SlopeCurve::relative(double slope) const {
  const double secant = std::hypot(1, slope), cosine = 1 / secant;
  switch (form_) {
    case SlopeForm::ikeuchi_exponential: {
      // d cos / d slope = -slope cos^3
      const double value = std::exp(exponential_rate * (1 - cosine));
      return {value, value * exponential_rate * slope * cosine * cosine * cosine};
    }
    case SlopeForm::ikeuchi_secant: {
      const double angle = secant_angle * std::atan(slope), value = 1 / std::cos(angle);
      return {value, value * std::tan(angle) * secant_angle * cosine * cosine};
    }
    case SlopeForm::ikeuchi_mixed: {
      const double held = std::min(slope, mixed_end), rise = mixed_part * held / std::hypot(1, held);
      return {1 - mixed_part + mixed_part * std::hypot(1, held),
              slope < mixed_end ? rise : slope > mixed_end ? 0 : rise / 2};
    }
    default: return {secant, slope * cosine};
  }
}

SlopeCurve::Value SlopeCurve::from_table(double slope) const {
  const double position = std::atan(slope) / step_rad_;
  const int last = static_cast<int>(yields_.size()) - 2;
  const int i = std::min(static_cast<int>(position), last);
  const double line = yields_[i + 1] - yields_[i];
  double steepness = line;
  if (i > 0 && position == i) steepness = (line + yields_[i] - yields_[i - 1]) / 2;
  return {yields_[i] + (position - i) * line, steepness / step_rad_ / (1 + slope * slope)};
}

SlopeCurve::Value SlopeCurve::at(double slope) const {
  if (form_ == SlopeForm::table) return from_table(slope);
  const Value value = relative(slope);
  return {flat_yield_ * value.yield, flat_yield_ * value.derivative};
}

}  // namespace surf
