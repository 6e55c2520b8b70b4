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
const double mixed_end = std::tan(70 * degree), held_secant = 1 / std::cos(70 * degree);

constexpr double most_yield = 1e12;

void check(const SlopeModelParameters& p, const SlopeChannel& channel) {
  const std::string name = "slope model, channel " + channel.name;
  if (p.form != SlopeForm::table) {
    if (channel.flat_yield > 0 && channel.flat_yield <= most_yield) return;
    throw InvalidInput(name, fmt::format("the yield of a flat surface is {}", channel.flat_yield),
                       "Give a finite number above 0");
  }
  if (channel.yields.size() < 2)
    throw InvalidInput(name, fmt::format("its table has {} yields", channel.yields.size()),
                       "Give two at least");
  if (!(p.table_step_deg > 0 &&
        p.table_step_deg * static_cast<double>(channel.yields.size() - 1) <= 90 + 1e-9))
    throw InvalidInput(name,
                       fmt::format("its table has {} yields in steps of {} degrees",
                                   channel.yields.size(), p.table_step_deg),
                       "Angles go from 0 to 90 degrees at most");
  for (const double yield : channel.yields)
    if (!(std::abs(yield) <= most_yield))
      throw InvalidInput(name, fmt::format("its table holds {}", yield),
                         "All yields must be finite");
}

/// Yields relative to a surface perpendicular to the beam, for all forms except tables.
void relative_yields(SlopeForm form, const SlopeRow& row, double* out) {
  const auto each = [&](const auto& yield) {
    for (int i = 0; i < row.count; ++i) out[i] = yield(row.secant[i], row.angle[i]);
  };
  switch (form) {
    case SlopeForm::ikeuchi_exponential:
      return each(
          [](double secant, double) { return std::exp(exponential_rate * (1 - 1 / secant)); });
    case SlopeForm::ikeuchi_secant:
      return each([](double, double angle) { return 1 / std::cos(secant_angle * angle); });
    case SlopeForm::ikeuchi_mixed:
      return each([](double secant, double) {
        return 1 - mixed_part + mixed_part * std::min(secant, held_secant);
      });
    default:
      return each([](double secant, double) { return secant; });
  }
}

/// Derivatives of the relative yields by the slope. The derivative of the angle is cos^2.
double relative_derivative(SlopeForm form, double slope, double secant, double angle) {
  const double cosine = 1 / secant;
  switch (form) {
    case SlopeForm::ikeuchi_exponential:
      return std::exp(exponential_rate * (1 - cosine)) * exponential_rate * slope * cosine *
             cosine * cosine;
    case SlopeForm::ikeuchi_secant:
      return std::tan(secant_angle * angle) / std::cos(secant_angle * angle) * secant_angle *
             cosine * cosine;
    case SlopeForm::ikeuchi_mixed: {
      const double rise = mixed_part * slope * cosine;
      return slope < mixed_end ? rise : slope > mixed_end ? 0 : rise / 2;
    }
    default:
      return slope * cosine;
  }
}

}  // namespace

SlopeCurves::SlopeCurves(const SlopeModelParameters& p)
    : form_(p.form), step_rad_(p.table_step_deg * degree) {
  for (const SlopeChannel& channel : p.channels) {
    check(p, channel);
    flat_yields_.push_back(channel.flat_yield);
    tables_.push_back(channel.yields);
  }
}

void SlopeCurves::times_flat_yields(int count, double* const* out) const {
  for (std::size_t c = channels();
       // The first channel comes last, because it holds the common factor of all.
       c-- > 0;)
    for (int i = 0; i < count; ++i) out[c][i] = flat_yields_[c] * out[0][i];
}

void SlopeCurves::yields(const SlopeRow& row, double* const* out) const {
  if (form_ != SlopeForm::table) {
    relative_yields(form_, row, out[0]);
    return times_flat_yields(row.count, out);
  }
  for (std::size_t c = 0; c < channels(); ++c) {
    const double* const table = tables_[c].data();
    const int last = static_cast<int>(tables_[c].size()) - 2;
    for (int i = 0; i < row.count; ++i) {
      const double position = row.angle[i] / step_rad_;
      const int at = std::min(static_cast<int>(position), last);
      out[c][i] = table[at] + (position - at) * (table[at + 1] - table[at]);
    }
  }
}

void SlopeCurves::derivatives(const SlopeRow& row, double* const* out) const {
  if (form_ != SlopeForm::table) {
    for (int i = 0; i < row.count; ++i)
      out[0][i] = relative_derivative(form_, row.tangent[i], row.secant[i], row.angle[i]);
    return times_flat_yields(row.count, out);
  }
  for (std::size_t c = 0; c < channels(); ++c) {
    const double* const table = tables_[c].data();
    const int last = static_cast<int>(tables_[c].size()) - 2;
    for (int i = 0; i < row.count; ++i) {
      const double position = row.angle[i] / step_rad_;
      const int at = std::min(static_cast<int>(position), last);
      double line = table[at + 1] - table[at];
      if (at > 0 && position == at) line = (line + table[at] - table[at - 1]) / 2;
      out[c][i] = line / step_rad_ / (row.secant[i] * row.secant[i]);
    }
  }
}

}  // namespace surf
