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
  double pixel_nm = 3;  ///< 0.1 to 100; the surfaces are designed for 0.5 to 10
  int size_px = 64;     ///< samples across, 16 to 4096
  int count = 60;       ///< 1 to 1000
  std::uint64_t seed = 1;
};

/// The number of kinds of surfaces.
inline constexpr int training_surface_kinds = 20;

/// Generates surfaces for the training of a model if there are no measured ones. The kinds are:
/// overlapping blocks and discs, some rotated, with walls of 1 to 6 pixels, also on rough ground
/// and as pits; Gaussian and self-affine rough surfaces; bumps and dimples; lines; plateaus and
/// lines of winding outline with smooth sides; pyramids with sides of 10 to 80 degrees; mixtures;
/// and single blocks, pits and lines on level ground, without which a model would know only crowded
/// surfaces. Each kind appears once before any kind is repeated; repetitions have other random
/// numbers and "-2", "-3" ... after the name.
///
/// Widths are proportional to the pixel or the field. Heights (5 to 45 nm, pyramids 10 to 60 nm)
/// are fixed, with two exceptions: they grow with pixels above 3 nm and shrink for fields below
/// 96 nm, so that walls stay equally steep. Throws UsageError for options out of range.
std::vector<NamedSurface> training_surfaces(const TrainingSurfaceOptions& options);

}  // namespace surf
