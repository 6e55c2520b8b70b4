// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/core/edge.h"
#include "surf/core/grid.h"
#include "surf/core/image.h"
#include "surf/core/parameters.h"
#include "surf/core/placed_image.h"
#include "surf/sem/calibration.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

/// Parameters of the fit of gains and offset.
struct CalibrateParameters {
  Edge edge = Edge::mirror;      ///< how heights continue outside, if a model images them
  std::vector<std::string> fit;  ///< channels to fit; empty: SE and BSE, as far as present
  std::optional<double> ratio;   ///< gain of the second channel divided by the first's
  std::optional<double> offset;  ///< known offset of the grey levels
  /// Pixels at or beyond these levels are saturated and left out.
  std::optional<double> black, white;
  std::optional<double> range_nm;  ///< half the width of the squares over which the gain may vary
};
/// The parameters calibration.edge, calibration.fit and so on.
void describe(ParameterVisitor& visit, CalibrateParameters& parameters);

/// Checks what can be checked without an image. Throws UsageError for values out of range, names
/// given twice and levels that contradict each other.
void check(const CalibrateParameters& parameters);

/// A microscope image and simulated channels of the same surface, pixel for pixel.
struct CalibrateInput {
  PlacedImage image;           ///< invalid pixels are ignored
  std::string name = "IMAGE";  ///< for messages, like `simulated_name`
  Image simulated;  ///< counts per primary; pixels that are 0 in a channel `valid` are ignored
  std::string simulated_name = "simulated";
};

struct CalibrateResult {
  Calibration calibration;
  /// Sum of the channels times their gains, including a varying gain, plus offset.
  Grid<double> fit;
  /// The image minus the fit, also at ignored pixels; NaN where either is unknown.
  Grid<double> residual;
  Grid<double> gain;  ///< the slowly varying gain; empty without `range_nm`

  bool trusted() const { return calibration.outcome == CalibrationOutcome::trusted; }
};

/// Fits by least squares (see surf/sem/calibration.h). Warns if the result cannot be trusted.
/// Throws UsageError for missing channels, InvalidInput for images of different pixels.
CalibrateResult calibrate(const CalibrateInput& input, const CalibrateParameters& parameters,
                          const Reporter& reporter = {});

}  // namespace surf::workflow
