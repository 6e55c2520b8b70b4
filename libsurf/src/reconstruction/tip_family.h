// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "surf/afm/tip.h"

namespace surf::reconstruction {

/// A change of the tip: logarithms of factors that its slope is multiplied by, at places from the
/// apex to the rim, denser towards the apex, which touches most; linear in between. So any change
/// of a tip is a tip: 0 at the apex, and falling outwards where it fell.
inline constexpr int tip_numbers = 7;
using TipChange = std::array<double, tip_numbers>;

/// Tips that differ from one by a TipChange. Which slope a tip has at a distance from its apex is
/// that of its median over all directions; heights of all directions there change by the same
/// factor.
class TipFamily {
 public:
  TipFamily() = default;
  explicit TipFamily(const Tip& finest);

  /// Whether there is a slope to change: not of a single sample, nor of a flat tip.
  bool can_change() const { return !slopes_.empty(); }

  /// `tip`, which may be of another pitch than the one given before, changed. `by_change`, if
  /// given, becomes the derivatives of its samples, row-major.
  Tip changed(const Tip& tip, const TipChange& change,
              std::vector<TipChange>* by_change = nullptr) const;

 private:
  double step_nm_ = 1;
  std::vector<double> slopes_;  // downwards, >= 0, of the steps from the apex on
};

}  // namespace surf::reconstruction
