// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// Options for the reconstruction of a tip from scans alone (Villarrubia, J. Res. NIST 102 (1997)
/// 425).
struct BlindTipOptions {
  /// Samples of the tip, >= 1, no larger than a scan; the apex is in the middle.
  int width = 21, height = 21;
  /// A sample of the tip is lowered only if it is higher than the scan demands by more than this
  /// threshold, and then to the demanded height plus the threshold. >= 0, nm. 0: the scans have no
  /// noise.
  double threshold_nm = 0;
  /// The threshold for samples straight above or below the apex, because neighbouring scan lines
  /// are farther apart in time (Todd and Eppell, Surf. Sci. 491 (2001) 473). Thresholds in other
  /// directions lie on an ellipse. Default: `threshold_nm`.
  std::optional<double> threshold_y_nm;
  /// How far the apex may penetrate the scan when the tip is tried at a point (thesis, 4.2), >= 0,
  /// nm. 0 is Villarrubia's algorithm, which sharpens flat and double tips too much.
  double apex_tolerance_nm = 0;
  /// Half the height of the layer that contains the true scan (Williams et al., J. Vac. Sci.
  /// Technol. B 16 (1998)), >= 0, nm. The bottom of the layer places the tip, the top carves it. 0:
  /// no layer.
  double layer_nm = 0;
  /// Whether points near the border count, but for the outermost rows and columns; beyond the
  /// border everything is allowed. If false, only
  /// those points count whose tip lies within the scan wherever it touches (as in Gwyddion). A scan
  /// less than twice as large as the tip has no such points.
  bool border = true;
  /// Uses only local maxima: quick, and an outer bound of the complete result.
  bool maxima_only = false;
  /// Initial outer bound, of this size and pitch; none: a flat tip.
  std::optional<Tip> start;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;      ///< reports rounds
};

struct BlindTipSummary {
  int rounds = 0;           ///< passes over all scans until no point lowers the tip
  std::int64_t points = 0;  ///< points of the scans that the tip was tried on
};

struct BlindTip {
  Tip tip;
  BlindTipSummary summary;
};

/// The largest tip that can have made every point of every scan. It is an outer bound of the true
/// tip if the noise never exceeds the thresholds. At each point x, some sample d of the tip must
/// have touched. The algorithm keeps what any of them allows, and repeats this until nothing
/// changes:
///     T(u) <= max over d of I(x - d + u) - I(x) + T(d),
///     where d satisfies I(x) - I(x - d) <= T(d) + apex tolerance.
/// The result does not depend on the order of the points, because each step can only lower the tip,
/// and lowers a larger tip less. Holes allow everything. All scans have the same pitch. Throws
/// InvalidInput, UsageError, Interrupted.
BlindTip blind_tip(const std::vector<HeightField>& scans, const BlindTipOptions& options);

}  // namespace surf
