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

/// How gains and offset are fitted.
struct CalibrateParameters {
  Edge edge = Edge::mirror;      ///< how heights go on outside, where a model images them
  std::vector<std::string> fit;  ///< channels; empty: SE and BSE, those that are there
  std::optional<double> ratio;   ///< gain of the second channel over the first's
  std::optional<double> offset;  ///< of the grey levels, where it is known
  std::optional<double> black,
      white;                       ///< pixels at or beyond these are saturated: they are left out
  std::optional<double> range_nm;  ///< half the width of squares over which the gain may vary
};
/// calibration.edge, calibration.fit and so on.
void describe(ParameterVisitor& visit, CalibrateParameters& parameters);

/// Throws UsageError for what no image has to be seen for: ranges, names given twice, levels that
/// contradict each other.
void check(const CalibrateParameters& parameters);

/// An image of a microscope, and simulated channels of the same surface, pixel on pixel.
struct CalibrateInput {
  PlacedImage image;           ///< what is not valid plays no part
  std::string name = "IMAGE";  ///< for messages, as the next
  Image simulated;             ///< counts per primary; what is 0 in a channel `valid` plays no part
  std::string simulated_name = "simulated";
};

struct CalibrateResult {
  Calibration calibration;
  Grid<double> fit;       ///< gains, those that vary too, times channels, plus offset
  Grid<double> residual;  ///< the image less the fit, also where it played no part; NaN where
                          ///< either is not known
  Grid<double> gain;      ///< that varies slowly; empty without `range_nm`

  bool trusted() const { return calibration.outcome == CalibrationOutcome::trusted; }
};

/// Least squares (see surf/sem/calibration.h). Warns of what cannot be trusted. Throws UsageError
/// for channels that are not there, InvalidInput for images of different pixels.
CalibrateResult calibrate(const CalibrateInput& input, const CalibrateParameters& parameters,
                          const Reporter& reporter = {});

}  // namespace surf::workflow
