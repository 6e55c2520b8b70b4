// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "surf/workflow/train_job.h"

namespace surf::cli {

/// Everything `train` is told, as text; absent: not given.
struct TrainOptions {
  std::vector<std::string> heights, images, signals, materials;
  std::optional<std::string> height_channel, z_unit, pitch, edge;
  std::optional<std::string> material, energy, spot, pixel_size, physics, cutoff;
  std::optional<std::string> surfaces, surface_size, hold_out, fine;
  std::optional<std::string> electrons, accuracy, seed, threads, cache;
  std::optional<std::string> model, scales, cut_off, hidden, iterations, decay, tolerance;
  std::optional<std::string> table_electrons, output;
  bool multi_resolution = false, quiet = false;
};

void add_train_options(CLI::App& app, TrainOptions& options);

/// The job; numbers are looked at before files are read. Throws UsageError, FileError.
workflow::TrainJob make_train_job(const TrainOptions& options);

}  // namespace surf::cli
