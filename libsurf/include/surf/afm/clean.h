// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

enum class Neighbourhood {
  square,  ///< |dx| <= radius and |dy| <= radius
  disc,    ///< dx^2 + dy^2 <= (radius + 1/2)^2
};

struct MedianOptions {
  int radius = 1;  ///< samples, 0 to 1000; 0 changes nothing
  Neighbourhood neighbourhood = Neighbourhood::square;
  /// Heights within this distance of the median stay (Williams 1998), >= 0; 0: all change.
  double limit_nm = 0;
  bool fill_holes = false;  ///< fill holes with the median of their neighbourhood
  int threads = 0;          ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

struct CleanSummary {
  std::size_t changed = 0;  ///< heights that the filter changed
  std::size_t filled = 0;   ///< holes that the filter filled
  std::size_t holes = 0;    ///< holes that remain
};

struct Cleaned {
  HeightField field;
  CleanSummary summary;
};

/// Replaces each height by the median of its neighbourhood (for an even number of samples, the mean
/// of the two middle ones). With a limit, only heights farther than the limit from the median are
/// replaced: this removes spikes and leaves the rest. At the border and near holes, the
/// neighbourhood consists of the samples that exist. The time grows linearly with the radius.
/// Throws InvalidInput, UsageError.
Cleaned median_filter(const HeightField& field, const MedianOptions& options);

struct ClosingOptions {
  int width = 3;  ///< samples along each side of the square, odd, 1 to 2001; 1 changes nothing
  bool fill_holes = false;  ///< fill holes that the closing reaches
  int threads = 0;          ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// Closing by a flat square (Castle 1998): a running maximum followed by a running minimum. It
/// fills pits that are narrower than the square in either direction up to their rim. Nothing else
/// rises and nothing falls; closing twice gives the same as once. Holes and places outside the
/// image are ignored in both steps. The time does not depend on the width (van Herk 1992,
/// doi:10.1016/0167-8655(92)90069-C; Gil and Werman 1993, doi:10.1109/34.211471). Throws
/// InvalidInput, UsageError.
Cleaned flat_closing(const HeightField& field, const ClosingOptions& options);

}  // namespace surf
