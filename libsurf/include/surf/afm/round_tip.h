// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/afm/tip.h"

namespace surf {

/// A tip's height at 0, 1, 2 ... steps of the finer pitch from its apex, nm: the height that a
/// `share` in [0, 1] of the directions around the apex do not exceed. The profile ends where fewer
/// than that share of the directions have samples, so it reaches into the corners of the tip's
/// square. Corners matter on scans of square plateaus. Throws InvalidInput for an invalid tip,
/// UsageError for a share out of range.
std::vector<double> round_profile_nm(const Tip& tip, double share);

/// A round tip that is nowhere above any of the profiles, each 0, 1, 2 ... steps of the finer pitch
/// from the apex, and whose side gets no less steep outwards: so it goes on where they end, down to
/// `depth_nm` > 0 but no farther from the apex than `most_samples`. Blind tips bound the true one
/// from outside, those of few samples the end, those of many the side, and of a scan of lines only
/// across them: if the tip is round, all of these bounds hold everywhere. Throws UsageError for
/// values out of range and profiles that do not begin with 0.
Tip tip_below(const std::vector<std::vector<double>>& profiles_nm, double pitch_x_nm,
              double pitch_y_nm, double depth_nm, int most_samples);

}  // namespace surf
