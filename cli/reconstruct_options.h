// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "chain_options.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::cli {

/// Everything `reconstruct` is told, as text.
struct ReconstructOptions {
  ChainOptions chain;
  std::optional<std::string> transform, gains, offset, calibration, sem_noise;
  std::optional<std::string> method, scales, iterations, tolerance, prior, upsample, probes;
  std::optional<std::string> output, truth;
  bool accept_registration = false, fixed_transform = false, fixed_calibration = false, no_uncertainty = false;
  bool keep_tip = false, refine_tip = false;
  bool no_picture = false;
};

void add_reconstruct_options(CLI::App& app, ReconstructOptions& options);

/// Reads the inputs. Throws UsageError, FileError, InvalidInput.
workflow::ReconstructJob make_reconstruct_job(const ReconstructOptions& options);

}  // namespace surf::cli
