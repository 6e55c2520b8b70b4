// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/sem/slope_model.h"

namespace surf {

/// Slopes of some pixels: tan theta >= 0, sec theta, and theta in radians.
struct SlopeRow {
  const double *tangent, *secant, *angle;
  int count;
};

/// A slope model's yields and their derivatives by the slope, tan theta. At a kink the derivative
/// is the mean of the derivatives on both sides. Computations that channels share are made once.
class SlopeCurves {
 public:
  /// Throws InvalidInput for parameters out of range.
  explicit SlopeCurves(const SlopeModelParameters& parameters);

  std::size_t channels() const { return tables_.size(); }
  /// Writes to out[channel][pixel].
  void yields(const SlopeRow& row, double* const* out) const;
  void derivatives(const SlopeRow& row, double* const* out) const;

 private:
  void times_flat_yields(int count, double* const* out) const;

  SlopeForm form_;
  double step_rad_;
  std::vector<double> flat_yields_;
  std::vector<std::vector<double>> tables_;
};

}  // namespace surf
