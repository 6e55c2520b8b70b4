// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "afm_masks.h"
#include "bound_parameters.h"
#include "picture_input.h"
#include "surf/core/edge.h"
#include "surf/io/sem_file.h"
#include "surf/mc/simulate.h"
#include "surf/sem/calibration.h"
#include "surf/sem/image_model.h"

namespace surf::cli {

/// What `calibrate` is told. Empty: not given.
struct CalibrateParameters {
  std::string image, heights;
  std::optional<std::string> images, model, output, residual, folded;
  std::vector<std::string> fit;            ///< channels; empty: SE and BSE, those that are there
  std::optional<double> ratio, offset, black, white, range_nm;
  Edge edge = Edge::mirror;
  io::SemReadOptions reading;              ///< its pixel size, of files that do not say
  MaskInput masks;
  mc::Execution execution;
};
void describe(ParameterVisitor& visit, CalibrateParameters& parameters);

struct CalibrateOptions {
  BoundParameters bound;
  bool quiet = false;
};

/// Everything that can be wrong before a file is read.
struct CalibratePlan {
  CalibrationOptions options;
  std::vector<std::string> channels;   // to fit; empty: SE and BSE, those that are there
  GivenPitch pitch;
  ModelOptions model;
  double range_nm = 0;
};

void add_calibrate_options(CLI::App& app, CalibrateOptions& options);

/// Throws UsageError, FileError for outputs that cannot be written.
CalibratePlan make_calibrate_plan(const CalibrateParameters& parameters);

}  // namespace surf::cli
