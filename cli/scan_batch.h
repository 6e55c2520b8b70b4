// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bound_parameters.h"

namespace surf::cli {

/// SCANS and how they are read, as add_scan_input, for commands that take one scan or many.
void add_scan_inputs(CLI::App& app, BoundParameters& bound, std::vector<std::string>& scans);

/// A scan, and the file that its result goes to; absent: none is written.
struct BatchStep {
  std::string scan;
  std::optional<std::string> output;
  bool one_of_many = false;
};

/// One scan to the file `output`. Of several scans, or of folders of scans, each to SCAN.gsf in the
/// folder `output`, which is made; so too if `output` is a folder. Throws UsageError where several
/// would go to one file, FileError.
std::vector<BatchStep> batch_of(const std::vector<std::string>& scans,
                                const std::optional<std::string>& output,
                                const std::string& command);

/// Does each step. Of several, those that fail are reported, and the others are done all the same;
/// returns the first failure's exit code, or 0.
int for_each_scan(const std::vector<BatchStep>& batch,
                  const std::function<void(const BatchStep&)>& work);

}  // namespace surf::cli
