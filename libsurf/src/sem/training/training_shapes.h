// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/height_field.h"
#include "surf/core/random.h"

namespace surf {

/// Makes random features on square fields about (0, 0). The random numbers depend only on the seed
/// and the number of the surface.
class TrainingShapes {
 public:
  TrainingShapes(double pixel_nm, int size_px, std::uint64_t seed, int surface);

  /// A level field.
  HeightField flat() const;

  /// Blocks and discs that rise from 0. Where they overlap, the higher one counts; some are added
  /// on top of others.
  HeightField blocks(int count, double highest_nm);
  /// One or two blocks or discs near the centre.
  HeightField island(double highest_nm);
  /// Bumps and dimples of Gaussian profile, as wide as 2 to 12 pixels, -1.5 to 2 times as high.
  HeightField bumps(int count);
  /// Parallel lines in any direction, 3 to 16 pixels wide, 5 to 25 apart.
  HeightField lines(double highest_nm);
  /// One line.
  HeightField line(double highest_nm);
  /// Plateaus of winding outline that cover about half of the field; their sides are error
  /// functions.
  HeightField pattern(double highest_nm);
  /// Lines of constant width, 3 to 16 pixels, that wind across the field; their sides are error
  /// functions.
  HeightField trace(double highest_nm);
  /// Square pyramids with sides of 10 to 80 degrees.
  HeightField pyramids(int count, double highest_nm);
  /// Rough surfaces: see make_rough, make_self_affine. Correlation lengths that are too long for
  /// the field are shortened.
  HeightField rough(double rms_nm, double correlation_nm);
  HeightField self_affine(double rms_nm, double correlation_nm, double hurst);

 private:
  double uniform(double from, double to);
  /// Distance from the winding outline of a random field, nm; > 0 inside.
  HeightField outline();
  double run();  ///< random length of a wall
  std::uint64_t seed();
  double shortened(double correlation_nm) const;

  double pixel_nm_;
  int size_px_;
  double half_nm_;
  RandomStream random_;
};

}  // namespace surf
