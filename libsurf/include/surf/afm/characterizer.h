// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf {

/// The tip from a scan of a characterizer whose shape is known (thesis, 2.1.2).
struct CharacterizerOptions {
  int width = 41, height = 41;  ///< samples of the tip, >= 1
  int search = 10;              ///< scan and characterizer are at most so many samples apart, >= 0
  int threads = 0;              ///< 0: one per hardware thread; the result does not depend on it
};

struct CharacterizedTip {
  Tip tip;  ///< an upper bound: what the characterizer did not touch is as wide as can be
  int offset_x = 0,
      offset_y = 0;        ///< the characterizer's sample (0, 0) lies at this sample of the scan
  double offset_z_nm = 0;  ///< added to the characterizer's heights in the scan
  bool offset_at_limit = false;  ///< then it may be farther off than `search`
  double residual_nm =
      0;  ///< root mean square of the scan less the characterizer dilated by the tip
};

/// T(u) = min over x of I(x + u) - C(x): the erosion of the scan by the characterizer is the tip's
/// structuring function, moved by what the two are apart. Its highest sample is the apex, and where
/// it lies is the offset. So that no offset has fewer bounds than another, only those x count from
/// which no u in question leaves the scan. Throws InvalidInput for invalid fields, other pitches,
/// options out of range, and characterizers of which too little is left.
CharacterizedTip tip_from_characterizer(const HeightField& scan, const HeightField& characterizer,
                                        const CharacterizerOptions& options = {});

}  // namespace surf
