// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "afm_masks.h"
#include "picture_input.h"
#include "surf/sem/calibration.h"
#include "surf/sem/image_model.h"

namespace surf::cli {

/// Everything `calibrate` is told, as text; absent: not given.
struct CalibrateOptions {
  std::string image, heights;
  std::optional<std::string> pixel_size, images, model, edge, folded, threads;
  std::optional<std::string> fit, ratio, offset, black, white, range, output, residual;
  MaskInput masks;
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
CalibratePlan make_calibrate_plan(const CalibrateOptions& options);

/// What a file that was made should tell of the options.
std::map<std::string, std::string> recorded(const CalibrateOptions& options);

}  // namespace surf::cli
