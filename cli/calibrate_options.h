// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "afm_masks.h"
#include "bound_parameters.h"
#include "surf/io/sem_file.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/calibrate_job.h"

namespace surf::cli {

/// What `calibrate` is told besides how to fit. Empty: not given.
struct CalibrateFiles {
  std::string image, heights;
  std::optional<std::string> images, model, output, residual, folded;
  io::SemReadOptions reading;  ///< its pixel size, of files that do not say
  MaskInput masks;
  mc::Execution execution;
};
void describe(ParameterVisitor& visit, CalibrateFiles& files);

struct CalibrateOptions {
  BoundParameters bound;
  bool quiet = false;
};

void add_calibrate_options(CLI::App& app, CalibrateOptions& options);

/// Everything that can be wrong before a file is read. Throws UsageError, FileError for outputs
/// that cannot be written.
void check(const CalibrateFiles& files, const workflow::CalibrateParameters& parameters);

}  // namespace surf::cli
