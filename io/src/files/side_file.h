// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

namespace surf::io {

/// The path of the file that `main` refers to by `name`. Returns nothing if the file is not in or
/// below the folder of `main` (or of the file that `main` is a link to), by its name or by links.
/// So a file from elsewhere cannot reach other files.
std::optional<std::filesystem::path> side_file(const std::filesystem::path& main,
                                               const std::filesystem::path& name);

}  // namespace surf::io
