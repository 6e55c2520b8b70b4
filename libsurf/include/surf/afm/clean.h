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
  double limit_nm =
      0;  ///< >= 0: heights within this of the median stay (Williams 1998); 0: all change
  bool fill_holes = false;  ///< holes with samples in their neighbourhood become its median
  int threads = 0;          ///< 0: one per hardware thread. Same result
  Watch watch;
};

struct CleanSummary {
  std::size_t changed = 0;  ///< heights that are not what they were
  std::size_t filled = 0;   ///< holes that are none any more
  std::size_t holes = 0;    ///< that are left
};

struct Cleaned {
  HeightField field;
  CleanSummary summary;
};

/// Each height becomes the median of its neighbourhood (of an even number, the mean of the two
/// middle ones), or does so only where it is farther than the limit from it, which takes spikes and
/// leaves the rest. At the border of the image and near holes the neighbourhood is what there is of
/// it. The time grows with the radius, not with its square. Throws InvalidInput, UsageError.
Cleaned median_filter(const HeightField& field, const MedianOptions& options);

struct ClosingOptions {
  int width = 3;  ///< samples along each side of the square, odd, 1 to 2001; 1 changes nothing
  bool fill_holes = false;  ///< holes that the closing reaches become its height
  int threads = 0;          ///< 0: one per hardware thread. Same result
  Watch watch;
};

/// Closing by a flat square (Castle 1998): the lowest of the highest heights around. Pits narrower
/// than the square in either direction are filled up to their rim, nothing else rises and nothing
/// falls; twice is the same as once. What is outside the image, and holes, take no part in either
/// step. The time does not grow with the width (van Herk 1992, doi:10.1016/0167-8655(92)90069-C;
/// Gil and Werman 1993, doi:10.1109/34.211471). Throws InvalidInput, UsageError.
Cleaned flat_closing(const HeightField& field, const ClosingOptions& options);

}  // namespace surf
