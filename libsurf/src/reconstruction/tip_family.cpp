// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_family.h"

#include <algorithm>
#include <cmath>

#include "surf/afm/round_tip.h"

namespace surf::reconstruction {
namespace {

// Places are at the rim's distance times (k / last) to this power.
constexpr double crowding = 1.5;

using Places = std::array<double, tip_places>;
using Waves = std::array<double, tip_waves>;

/// The weight of each of the places at a step, by linear interpolation between two neighbours.
Places shares(std::size_t step, std::size_t steps) {
  const double share = (static_cast<double>(step) + 0.5) / static_cast<double>(steps);
  const double at = std::pow(share, 1 / crowding) * (tip_places - 1);
  const int before = std::min(static_cast<int>(at), tip_places - 2);
  Places s{};
  s[before] = before + 1 - at;
  s[before + 1] = at - before;
  return s;
}

/// The waves in the direction (x, y).
Waves waves(double x, double y) {
  const double r = std::hypot(x, y);
  if (r == 0) return {1, 0, 0, 0, 0};
  const double c = x / r, s = y / r;
  return {1, c, s, second_wave * (c * c - s * s), second_wave * 2 * c * s};
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
  const std::size_t steps = slopes_.size();
  std::vector<Places> share;
  for (std::size_t i = 0; i < steps; ++i) share.push_back(shares(i, steps));
  for (int y = 0; y < tip.z_nm.height(); ++y)
    for (int x = 0; x < tip.z_nm.width(); ++x) {
      const double z = tip.z_nm(x, y);
      if (z == 0 || !std::isfinite(z)) continue;
      const double from_x = (x - tip.apex_x) * tip.pitch_x_nm,
                   from_y = (y - tip.apex_y) * tip.pitch_y_nm;
      const Waves wave = waves(from_x, from_y);
      Places exponent{};
      for (int p = 0; p < tip_places; ++p)
        for (int m = 0; m < tip_waves; ++m)
          exponent[p] += wave[m] * change[static_cast<std::size_t>(p * tip_waves + m)];
      // Constant beyond the rim.
      const double at = std::min(std::hypot(from_x, from_y) / step_nm_, static_cast<double>(steps));
      const std::size_t i = std::min(static_cast<std::size_t>(at), steps - 1);
      // Factor of the height at the end of a step, and its derivatives by the places. No factor
      // changes the apex or a flat end.
      double before = 0, after = 0, factor = 1;
      Places by_place{}, slope{};
      double inner = 1;
      Places inner_slope{};
      for (std::size_t k = 0; k <= i; ++k) {
        inner = factor;
        inner_slope = slope;
        double sum = 0;
        for (int p = 0; p < tip_places; ++p) sum += share[k][p] * exponent[p];
        const double fall = slopes_[k] * std::exp(sum);
        before += slopes_[k];
        after += fall;
        for (int p = 0; p < tip_places; ++p) by_place[p] += fall * share[k][p];
        if (!(before > 0)) continue;
        factor = after / before;
        for (int p = 0; p < tip_places; ++p) slope[p] = by_place[p] / before;
        if (k == 0) inner = factor, inner_slope = slope;
      }
      const double t = at - static_cast<double>(i);
      if (changes) out.z_nm(x, y) = z * ((1 - t) * inner + t * factor);
      if (!by_change) continue;
      TipChange& d = (*by_change)[static_cast<std::size_t>(y) * tip.z_nm.width() + x];
      for (int p = 0; p < tip_places; ++p)
        for (int m = 0; m < tip_waves; ++m)
          d[static_cast<std::size_t>(p * tip_waves + m)] =
              z * wave[m] * ((1 - t) * inner_slope[p] + t * slope[p]);
    }
  return out;
}

}  // namespace surf::reconstruction
