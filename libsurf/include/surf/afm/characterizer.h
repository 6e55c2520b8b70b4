// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf {

/// Options for `tip_from_characterizer` (thesis, 2.1.2).
struct CharacterizerOptions {
  int width = 41, height = 41;  ///< samples of the tip, >= 1
  /// Largest offset between scan and characterizer, in samples, >= 0.
  int search = 10;
  int threads = 0;  ///< 0: one per hardware thread; the result does not depend on it
};

struct CharacterizedTip {
  /// An upper bound: where the characterizer was not touched, the tip is as wide as possible.
  Tip tip;
  /// Sample (0, 0) of the characterizer lies at this sample of the scan.
  int offset_x = 0, offset_y = 0;
  double offset_z_nm = 0;  ///< added to the characterizer's heights in the scan
  /// True: the offset is at the limit of `search` and may really be larger.
  bool offset_at_limit = false;
  /// Root mean square of the difference between the scan and the characterizer dilated by the tip.
  double residual_nm = 0;
};

/// Reconstructs a tip from the scan of a characterizer of known shape: T(u) = min over x of I(x +
/// u) - C(x). The erosion of the scan by the characterizer is the tip's structuring function,
/// shifted by the offset between scan and characterizer. Its highest sample is the apex; the
/// position of that sample gives the offset. Only points x count from which no u leaves the scan,
/// so that every offset has the same number of bounds. Throws InvalidInput for invalid fields,
/// pitches that differ, options out of range, and if too little of the characterizer is left.
CharacterizedTip tip_from_characterizer(const HeightField& scan, const HeightField& characterizer,
                                        const CharacterizerOptions& options = {});

}  // namespace surf
