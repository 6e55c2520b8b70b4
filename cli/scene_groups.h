// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include "scene_options.h"

namespace surf::cli {

// Options that say what is simulated, in groups of the help: for every command that takes a scene.

void add_specimen_options(CLI::App& app, SceneOptions& options);
void add_beam_options(CLI::App& app, SceneOptions& options);
/// Current and dwell time, in the beam's group: right after `add_beam_options`.
void add_dose_options(CLI::App& app, SceneOptions& options);
void add_scan_options(CLI::App& app, SceneOptions& options);
void add_physics_options(CLI::App& app, SceneOptions& options);

}  // namespace surf::cli
