// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/sem/slope_model.h"

namespace surf::bench {

/// Brightness as a function of the slopes p = dz/dx and q = dz/dy, relative to level ground: R(0,
/// 0) = 1. It depends on p^2 + q^2 alone and is smooth, with a derivative of zero at level ground.
class ReflectanceMap {
 public:
  /// Grey levels at the angles 0, step, 2 step ... below 90 degrees; at least two. Between them a
  /// cubic that rises where they rise (Fritsch and Carlson 1980, doi:10.1137/0717021), beyond the
  /// last one a line.
  ReflectanceMap(double step_deg, std::vector<double> grey_levels);

  struct Value {
    double r, by_p, by_q;
  };
  Value at(double p, double q) const;

  /// Grey level of level ground, in the image's unit.
  double level_ground() const { return level_ground_; }

 private:
  double level_ground_, step_rad_;
  std::vector<double> levels_, slopes_;  // relative, and their derivatives by the angle
};

/// The grey levels of planes as a slope model predicts them: offset + sum of gain * yield, every 5
/// degrees up to 85. One gain per channel.
ReflectanceMap reflectance_of(const SlopeModelParameters& slopes, const std::vector<double>& gains,
                              double offset);

}  // namespace surf::bench
