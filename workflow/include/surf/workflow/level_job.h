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
  none,        ///< nothing is taken off
};

struct LevelParameters {
  LevelMethod method = LevelMethod::hough;
  int degree = 2;                      ///< degree of the polynomial
  std::optional<double> tolerance_nm;  ///< for hough; absent: from the heights
  std::optional<RowMethod> rows;       ///< also take off steps between scan lines
};
/// The parameters level.method, level.degree, level.tolerance and level.rows.
void describe(ParameterVisitor& visit, LevelParameters& parameters);

struct LevelResult {
  HeightField field;
  /// 1 for samples that rows and roughness are judged by: the plane's inliers with hough, else
  /// `use`.
  Mask substrate;
  std::optional<Plane> plane;         ///< the plane taken off last, with hough and plane
  std::optional<HoughSummary> hough;  ///< for the plane taken off last; its inliers are `substrate`
  std::optional<RowLevel> rows;
  double tilt_deg = 0;  ///< largest tilt that was taken off
};

/// Takes the background off. With `rows`, then takes off the steps between rows, judged by the
/// substrate, and the remaining background once more. Samples that are 0 in `use` (of the scan's
/// size, or empty) do not take part in the fits. Throws InvalidInput, UsageError, Interrupted.
LevelResult level(const HeightField& scan, const LevelParameters& parameters, const Mask& use = {},
                  const Reporter& reporter = {});

}  // namespace surf::workflow
