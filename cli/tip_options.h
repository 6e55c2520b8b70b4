// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf::cli {

/// --tip, required.
void add_tip_input(CLI::App& app, std::optional<std::string>& file);

/// Reads it as `workflow::tip_for` has it meet the field; notes are printed unless `quiet`. Throws
/// UsageError, FileError, InvalidInput.
Tip read_tip_for(const std::optional<std::string>& file, const HeightField& field, bool quiet);

}  // namespace surf::cli
