// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene_options.h"

namespace surf::cli {

/// Everything `simulate` is told, as text; absent: not given.
struct SimulateOptions {
  SceneOptions scene;
  std::optional<std::string> electrons, accuracy, accuracy_floor, time, mesh_tolerance, method, seed, threads, cache;
  std::vector<std::string> outputs;
  std::string channel, channels, layout = "auto";
  std::optional<std::string> deposit, trajectories, trajectories_at;
  std::optional<std::string> checkpoint, checkpoint_every;
  bool restart = false;
  bool dry_run = false;
  bool spectra = false;
  bool quiet = false;
};

/// Declares specimen, beam, scan and how it is simulated, with their help: all but outputs, what else is recorded and
/// checkpoints.
void add_simulate_settings(CLI::App& app, SimulateOptions& options);

/// Declares them all, with their help.
void add_simulate_options(CLI::App& app, SimulateOptions& options);

}  // namespace surf::cli
