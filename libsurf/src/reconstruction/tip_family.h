// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "surf/afm/tip.h"

namespace surf::reconstruction {

/// A change of the tip: logarithms of the factors of its slope, at places from the apex to the rim,
/// linearly interpolated. The places are denser towards the apex, which touches most. At each place
/// there are five numbers, for waves around the axis: the same in all directions, a tip that leans
/// (cosine and sine of the azimuth), one that is wider along one axis (of twice the azimuth, times
/// `second_wave`). So every change of a tip gives a tip: 0 at the apex, and falling outwards where
/// the original tip falls.
inline constexpr int tip_places = 7, tip_waves = 5, tip_numbers = tip_places * tip_waves;
inline constexpr double second_wave = 0.75;
using TipChange = std::array<double, tip_numbers>;

/// Tips that differ from a given tip by a TipChange. The slope at a distance from the apex is that
/// of the median over all directions; heights change by the factor that this median changes by.
class TipFamily {
 public:
  TipFamily() = default;
  explicit TipFamily(const Tip& finest);

  /// Whether there is a slope to change: false for a single sample and for a flat tip.
  bool can_change() const { return !slopes_.empty(); }

  /// Changes `tip`, which may have another pitch than the tip of the constructor. `by_change`, if
  /// given, is set to the derivatives of the samples, row-major.
  Tip changed(const Tip& tip, const TipChange& change,
              std::vector<TipChange>* by_change = nullptr) const;

 private:
  double step_nm_ = 1;
  std::vector<double> slopes_;  // downward slopes, >= 0, of the steps from the apex on
};

}  // namespace surf::reconstruction
