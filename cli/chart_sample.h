// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

namespace surf::cli {

/// What `chart` is told of a sample's folder, as text.
struct ChartSampleOptions {
  std::string sample;   ///< the folder
  std::optional<std::string> output, methods, draws, model, seed, threads;
  bool quick = false, quiet = false;
};

/// Of samples alone.
void add_chart_sample_options(CLI::App& app, ChartSampleOptions& options);

/// The part of the help that lists the methods for samples.
std::string chart_sample_methods();

/// Registration and reconstruction of a folder that `semsurf sample` made: the exit code.
int chart_sample(const ChartSampleOptions& options, const std::string& command_line);

}   // namespace surf::cli
