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

/// A round tip that lies on or below all of the profiles. Each profile gives heights at 0, 1, 2 ...
/// steps of the finer pitch from the apex. The side of the tip never becomes less steep outwards:
/// beyond the profiles it continues with its last slope, down to `depth_nm` > 0 but no farther than
/// `most_samples` steps from the apex. A blind tip is an outer bound of the true tip. Blind tips of
/// few samples bound the end of the tip, those of many samples bound its side, and scans of
/// parallel lines bound the tip only across the lines. If the tip is round, all these bounds hold
/// in every direction. Throws UsageError for values out of range and profiles that do not begin
/// with 0.
Tip tip_below(const std::vector<std::vector<double>>& profiles_nm, double pitch_x_nm,
              double pitch_y_nm, double depth_nm, int most_samples);

}  // namespace surf
