// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <string>

#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

struct AlignOptions {
  /// True: the places that the two surfaces state agree already. Lift and tilt alone are fitted.
  bool held = false;
  /// Farthest shift along x and along y that is searched for, nm, >= 0. Infinite: wherever enough
  /// of the surfaces overlaps.
  double largest_shift_nm = std::numeric_limits<double>::infinity();
  double least_overlap = 0.5;  ///< share of the smaller surface that must lie in the other, (0, 1]
  Watch watch;
};

enum class AlignmentVerdict {
  aligned,    ///< one shift fits, and no other one nearly as well
  held,       ///< the shift was told
  ambiguous,  ///< another shift, or a continuum of shifts, fits as well
  unrelated,  ///< the surfaces agree nowhere more than chance allows
};

/// The place of a surface `after` on a surface `before`.
struct SurfaceAlignment {
  AlignmentVerdict verdict = AlignmentVerdict::unrelated;
  Point2 shift_nm;     ///< to add to places of `after`
  double lift_nm = 0;  ///< to take off `after`, at `centre_nm`
  /// Also to take off `after`: the slope of a plane along x and y, nm per nm.
  double tilt_x = 0, tilt_y = 0;
  Point2 centre_nm;  ///< in the frame of `before`
  /// Covariance of shift x, shift y, lift, tilt x and tilt y, row-major. It holds for errors that
  /// are correlated over some pixels (sandwich estimate over blocks: Liang and Zeger 1986,
  /// doi:10.1093/biomet/73.1.13).
  std::array<double, 25> covariance{};
  /// Robust deviation of single walls from the places that the shift gives them, in samples of
  /// `before`: more than the shift's error where walls are steeper than samples show.
  double place_error_px = 0;
  double correlation = 0;  ///< of the aligned surfaces, planes taken off, -1 to 1
  /// Fisher's z of the correlation over its standard error: what chance gives is about 1.
  double evidence = 0;
  double overlap = 0;  ///< share of the samples of `before` under which `after` has a height
  std::string reason;  ///< for people: why the verdict, and what to do; empty if all is well

  bool usable() const {
    return verdict == AlignmentVerdict::aligned || verdict == AlignmentVerdict::held;
  }
};

/// Finds the shift, lift and tilt that lay `after` on `before`. Whole pixels are found by
/// correlation, fractions of a pixel by iteratively reweighted least squares with Tukey's biweight,
/// so that changed places do not count. Both surfaces are smoothed by a pixel first: walls narrower
/// than a pixel would otherwise draw the shift to whole or half pixels. Pitches may differ by up to
/// a factor of 4. Throws InvalidInput for surfaces that are invalid or smaller than 16 x 16, for
/// other pitches, and if a held shift leaves fewer than 64 common samples; UsageError for options
/// out of range; Interrupted.
SurfaceAlignment align_surfaces(const HeightField& before, const HeightField& after,
                                const AlignOptions& options = {});

}  // namespace surf
