// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// How a tip is reconstructed from scans alone (Villarrubia, J. Res. NIST 102 (1997) 425).
struct BlindTipOptions {
  int width = 21,
      height = 21;  ///< samples of the tip, >= 1, no larger than a scan; apex in the middle
  /// A sample of the tip is lowered only by more than this, to this much above what the scan
  /// demands,
  /// >= 0, nm. 0: the scans have no noise.
  double threshold_nm = 0;
  /// The same for samples straight above or below the apex, where scan lines lie farther apart in
  /// time (Todd and Eppell, Surf. Sci. 491 (2001) 473); in between by direction, as on an ellipse.
  /// Default: the same.
  std::optional<double> threshold_y_nm;
  /// How far the apex may stick out of the scan where the tip is tried (thesis, 4.2), >= 0, nm. 0
  /// is Villarrubia's algorithm, which sharpens flat and double tips too much.
  double apex_tolerance_nm = 0;
  /// Half the height of the layer that the true scan lies in (Williams et al., J. Vac. Sci.
  /// Technol. B 16 (1998)): its bottom places the tip, its top carves it; >= 0, nm. 0: no layer.
  double layer_nm = 0;
  /// Points near the border count, too; what lies beyond it allows everything. Without, only those
  /// whose tip, wherever it touches, lies within the scan (as in Gwyddion): none in a scan less
  /// than twice as large as the tip.
  bool border = true;
  /// Local maxima only: quick, and an outer bound of the whole answer.
  bool maxima_only = false;
  std::optional<Tip> start;  ///< an outer bound to begin with, of this size and pitch; none: flat
  int threads = 0;           ///< 0: one per hardware thread. Does not change the result
  Watch watch;               ///< counts rounds
};

struct BlindTipSummary {
  int rounds = 0;           ///< passes over all scans, until no point of any lowers the tip
  std::int64_t points = 0;  ///< points of the scans that were tried on the tip
};

struct BlindTip {
  Tip tip;
  BlindTipSummary summary;
};

/// The largest tip that can have made every point of every scan: the outer bound of the true one
/// where noise never exceeds the thresholds. Of each point x the algorithm keeps, of all ways d to
/// touch it, what any allows:
///   T(u) <= max over d of I(x - d + u) - I(x) + T(d),   d: I(x) - I(x - d) <= T(d) + apex
///   tolerance,
/// until nothing changes. The result does not depend on the order of points, since each step can
/// only lower the tip, and lowers it less where it is larger. Holes allow everything. All scans
/// have one pitch. Throws InvalidInput, UsageError, Interrupted.
BlindTip blind_tip(const std::vector<HeightField>& scans, const BlindTipOptions& options);

}  // namespace surf
