// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

namespace surf::cli {

/// What the chosen subcommand does once the command line is parsed; returns the exit code.
using Action = std::function<int()>;

// Each adds a subcommand that sets `action`. Options' type names say how to complete their values:
// FILE, MATERIAL, or the choices as "a|b|c".
void add_simulate(CLI::App& app, Action& action, const std::string& command_line);
void add_chart(CLI::App& app, Action& action, const std::string& command_line);
void add_sweep(CLI::App& app, Action& action, const std::string& command_line);
void add_former_join(CLI::App& app, Action& action);  // 'semsurf join', hidden
void add_level(CLI::App& app, Action& action);
void add_clean(CLI::App& app, Action& action);
void add_survey(CLI::App& app, Action& action);
void add_noise(CLI::App& app, Action& action);
void add_mesh(CLI::App& app, Action& action);
void add_erode(CLI::App& app, Action& action);
void add_dilate(CLI::App& app, Action& action);
void add_open(CLI::App& app, Action& action);
void add_close(CLI::App& app, Action& action);
void add_certainty(CLI::App& app, Action& action);
void add_train(CLI::App& app, Action& action);
void add_predict(CLI::App& app, Action& action);
void add_estimate(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_materials(CLI::App& app, Action& action);
void add_library(CLI::App& app, Action& action);
void add_profile(CLI::App& app, Action& action);
void add_register(CLI::App& app, Action& action);
void add_refine(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action, const std::string& command_line);
void add_reconstruct(CLI::App& app, Action& action, const std::string& command_line);
void add_tip(CLI::App& app, Action& action);
void add_calibrate(CLI::App& app, Action& action);
void add_sample(CLI::App& app, Action& action);
void add_view(CLI::App& app, Action& action);
void add_completion(CLI::App& app, Action& action);

}  // namespace surf::cli
