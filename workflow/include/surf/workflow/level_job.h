// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/afm/background.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/row_level.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

enum class LevelMethod {
  hough,       ///< the plane that most of the scan lies on
  plane,       ///< the mean plane
  polynomial,  ///< of `degree`
  none,        ///< the scan is level
};

struct LevelParameters {
  LevelMethod method = LevelMethod::hough;
  int degree = 2;                      ///< of the polynomial
  std::optional<double> tolerance_nm;  ///< of hough; else from the heights
  std::optional<RowMethod> rows;       ///< steps between scan lines are taken off too
};
/// level.method, level.degree, level.tolerance and level.rows.
void describe(ParameterVisitor& visit, LevelParameters& parameters);

struct LevelResult {
  HeightField field;
  Mask
      substrate;  ///< 1 where rows and roughness go by it: of hough the plane's inliers, else `use`
  std::optional<Plane> plane;         ///< the one taken off last, of hough and plane
  std::optional<HoughSummary> hough;  ///< of the plane taken off last; its inliers are `substrate`
  std::optional<RowLevel> rows;
  double tilt_deg = 0;  ///< that was taken off, the largest
};

/// The background is taken off; with `rows` then the rows by what lies on it, and once more what is
/// left of it. Samples that are 0 in `use` (of the scan's size, or empty) do not decide. Throws
/// InvalidInput, UsageError, Interrupted.
LevelResult level(const HeightField& scan, const LevelParameters& parameters, const Mask& use = {},
                  const Reporter& reporter = {});

}  // namespace surf::workflow
