// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surf/core/height_field.h"

namespace surf {

struct NamedSurface {
  std::string name;   ///< fit for a file's name
  HeightField field;  ///< centred on (0, 0)
};

struct TrainingSurfaceOptions {
  double pixel_nm = 3;  ///< 0.1 to 100; the mixture is meant for 0.5 to 10
  int size_px = 64;     ///< samples across, 16 to 4096
  int count = 60;       ///< 1 to 1000
  std::uint64_t seed = 1;
};

/// How many kinds of surfaces there are.
inline constexpr int training_surface_kinds = 20;

/// Surfaces to learn a model on where there are none of one's own: blocks and discs, overlapping,
/// some turned, with walls of 1 to 6 pixels, also on rough ground and as pits; Gaussian and
/// self-affine rough ones; bumps and dimples; lines; plateaus and lines of winding outline with
/// smooth sides; pyramids with sides of 10 to 80 degrees; mixtures; and single blocks, pits and
/// lines on level ground, without which a model knows crowds only. Each kind comes once before any
/// comes again, with other random numbers and "-2", "-3" ... after its name.
///
/// Widths go with the pixel and the field, heights (5 to 45 nm) are what they are: but for pixels
/// above 3 nm they grow with them, and for fields below 96 nm they shrink, so that walls stay as
/// steep. Throws UsageError for options out of range.
std::vector<NamedSurface> training_surfaces(const TrainingSurfaceOptions& options);

}  // namespace surf
