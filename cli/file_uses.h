// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "surf/io/overlaps.h"

namespace surf::cli {

/// The file of an option, and what is read with it: the files that a scene names, a mesh's buffers
/// and so on. FILE:CHANNEL is the file; what is no file has none.
std::vector<io::FileUse> files_read(const std::string& option, const std::string& value);

/// Throws UsageError where the parsed command would write over one of its inputs, or would write
/// one file twice: what is done with the file of an option, `file_role` tells.
void refuse_overlaps(const CLI::App& command);

}  // namespace surf::cli
