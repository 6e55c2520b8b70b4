// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading_doubt.h"

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

constexpr double from_above = 0.2;        // of the height; chosen on 18 lines of bench_views
constexpr double bottom_of_hole = 0.04;   // of the depth, at any tilt; holes of bench_profile
constexpr double end_of_flank_nm = 0.26;  // in the image; chosen on 3 lines of bench_views

}  // namespace

double shading_doubt_nm(double height_nm) { return from_above * height_nm; }

double height_doubt_nm(const HeightEvidence& by) {
  const double upright_nm = shading_doubt_nm(by.height_nm);
  if (by.tilt_deg == 0) return upright_nm;
  if (by.kind == FeatureKind::hole) return bottom_of_hole * by.height_nm;
  return std::min(upright_nm, end_of_flank_nm / std::sin(by.tilt_deg * degrees_to_radians));
}

Measured doubted(const Measured& fitted, const NumberPrior& prior, double doubt) {
  if (!(prior.deviation > 0) || !(fitted.standard_error > 0)) return fitted;
  const double known = 1 / (prior.deviation * prior.deviation),
               both = 1 / (fitted.standard_error * fitted.standard_error),
               told = both - known;                       // by the data
  if (!(told > 0)) return {prior.mean, prior.deviation};  // nothing for sure
  const double by_data = (fitted.value * both - prior.mean * known) / told,
               less = 1 / (1 / told + doubt * doubt);
  return {(prior.mean * known + by_data * less) / (known + less), 1 / std::sqrt(known + less)};
}

std::array<Measured, profile_numbers> doubted_height(
    const std::array<Measured, profile_numbers>& fitted, const NumberPrior& prior,
    double doubt_nm) {
  if (!(prior.deviation > 0) || doubt_nm == 0) return fitted;
  auto out = fitted;
  Measured &height = out[profile_height], &angle = out[profile_angle];
  const Measured before = height;
  height = doubted(before, prior, doubt_nm);
  const double flank_nm = before.value / std::tan(angle.value * degrees_to_radians),
               a = std::atan2(height.value, flank_nm),
               more = std::sqrt(std::max(
                   0.0, std::pow(height.standard_error, 2) - std::pow(before.standard_error, 2)));
  if (angle.standard_error > 0)
    angle = {a / degrees_to_radians,
             std::hypot(angle.standard_error, std::abs(std::sin(a) * std::cos(a)) * more /
                                                  std::abs(height.value) / degrees_to_radians)};
  bool possible = height.value > 0;
  try {
    if (possible)
      wall_profile({height.value, angle.value, out[profile_top].value, out[profile_foot].value});
  } catch (const InvalidInput&) {  // no wall has such corners
    possible = false;
  }
  if (!possible) height.value = before.value, angle.value = fitted[profile_angle].value;
  return out;
}

}  // namespace surf::workflow
