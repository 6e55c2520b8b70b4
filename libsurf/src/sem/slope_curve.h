// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/sem/slope_model.h"

namespace surf {

/// A slope model's yield and its derivative by the slope, tan theta >= 0. At a kink the derivative is the mean
/// of those to both sides.
class SlopeCurve {
 public:
  /// Throws InvalidInput for parameters out of range.
  SlopeCurve(const SlopeModelParameters& parameters, const SlopeChannel& channel);

  struct Value {
    double yield = 0, derivative = 0;
  };
  Value at(double slope) const;

 private:
  Value relative(double slope) const;
  Value from_table(double slope) const;

  SlopeForm form_;
  double flat_yield_, step_rad_;
  std::vector<double> yields_;
};

}  // namespace surf
