// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_family.h"

#include <algorithm>
#include <cmath>

#include "surf/afm/round_tip.h"

namespace surf::reconstruction {
namespace {

// Places are at the rim's distance times (k / last) to this power.
constexpr double crowding = 1.5;

/// The weight of each of the numbers at a step, by linear interpolation between two neighbours.
TipChange shares(std::size_t step, std::size_t steps) {
  const double share = (static_cast<double>(step) + 0.5) / static_cast<double>(steps);
  const double at = std::pow(share, 1 / crowding) * (tip_numbers - 1);
  const int before = std::min(static_cast<int>(at), tip_numbers - 2);
  TipChange s{};
  s[before] = before + 1 - at;
  s[before + 1] = at - before;
  return s;
}

}  // namespace

TipFamily::TipFamily(const Tip& finest) : step_nm_(std::min(finest.pitch_x_nm, finest.pitch_y_nm)) {
  const std::vector<double> profile = round_profile_nm(finest, 0.5);
  for (std::size_t i = 1; i < profile.size() && std::isfinite(profile[i]); ++i)
    slopes_.push_back(std::max((profile[i - 1] - profile[i]) / step_nm_, 0.0));
  if (std::ranges::all_of(slopes_, [](double s) { return s == 0; })) slopes_.clear();
}

Tip TipFamily::changed(const Tip& tip, const TipChange& change,
                       std::vector<TipChange>* by_change) const {
  Tip out = tip;
  if (by_change) by_change->assign(tip.z_nm.size(), {});
  if (slopes_.empty()) return out;
  const bool changes = std::ranges::any_of(change, [](double c) { return c != 0; });
  if (!changes && !by_change) return out;
  // Factors of the heights at the ends of all steps, and their derivatives. No factor changes the
  // apex or a flat end.
  const std::size_t steps = slopes_.size();
  std::vector<double> factor(steps + 1, 1.0);
  std::vector<TipChange> slope_of_factor(steps + 1, TipChange{});
  double before = 0, after = 0;
  TipChange slope_of_depth{};
  for (std::size_t i = 0; i < steps; ++i) {
    const TipChange s = shares(i, steps);
    double exponent = 0;
    for (int k = 0; k < tip_numbers; ++k) exponent += s[k] * change[k];
    const double fall = slopes_[i] * std::exp(exponent);
    before += slopes_[i];
    after += fall;
    for (int k = 0; k < tip_numbers; ++k) slope_of_depth[k] += fall * s[k];
    if (!(before > 0)) continue;
    factor[i + 1] = after / before;
    for (int k = 0; k < tip_numbers; ++k) slope_of_factor[i + 1][k] = slope_of_depth[k] / before;
  }
  factor[0] = factor[1];
  slope_of_factor[0] = slope_of_factor[1];
  for (int y = 0; y < tip.z_nm.height(); ++y)
    for (int x = 0; x < tip.z_nm.width(); ++x) {
      const double z = tip.z_nm(x, y);
      if (z == 0 || !std::isfinite(z)) continue;
      const double r =
          std::hypot((x - tip.apex_x) * tip.pitch_x_nm, (y - tip.apex_y) * tip.pitch_y_nm) /
          step_nm_;
      const double at = std::min(r, static_cast<double>(steps));  // constant beyond the rim
      const std::size_t i = std::min(static_cast<std::size_t>(at), steps - 1);
      const double t = at - static_cast<double>(i);
      if (changes) out.z_nm(x, y) = z * ((1 - t) * factor[i] + t * factor[i + 1]);
      if (!by_change) continue;
      TipChange& d = (*by_change)[static_cast<std::size_t>(y) * tip.z_nm.width() + x];
      for (int k = 0; k < tip_numbers; ++k)
        d[k] = z * ((1 - t) * slope_of_factor[i][k] + t * slope_of_factor[i + 1][k]);
    }
  return out;
}

}  // namespace surf::reconstruction
