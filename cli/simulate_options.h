// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bound_parameters.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/workflow/simulate_job.h"

namespace surf::cli {

/// What `simulate` and its relatives are told.
struct SimulateOptions {
  BoundParameters parameters;
  bool dry_run = false;
  bool quiet = false;
};

/// Declares the specimen's files, and all parameters of the request but those that are named.
void add_request_options(CLI::App& app, BoundParameters& parameters,
                         const std::vector<std::string>& without);

/// Declares all of a simulation but outputs, what else is recorded and checkpoints: what a sweep
/// can vary.
void add_simulate_settings(CLI::App& app, SimulateOptions& options);

/// Declares all of a simulation.
void add_simulate_options(CLI::App& app, SimulateOptions& options);

/// The specimen and what is asked of it. Notes go to the user unless they are quiet. Throws
/// UsageError, FileError and InvalidInput.
io::SceneFile read_scene(const GivenTexts& given, bool quiet, const io::BodyReader& read);

/// The job that texts ask for, likewise.
workflow::SimulateJob make_simulate_job(const GivenTexts& given, bool quiet,
                                        const std::string& command_line,
                                        const io::BodyReader& read);

}  // namespace surf::cli
