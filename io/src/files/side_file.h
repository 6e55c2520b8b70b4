// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

namespace surf::io {

/// Where the file is that `main` calls `name`; nothing where it is not in or below the folder of
/// `main` (or of the file that `main` is a link to), by its name or by links. A file from elsewhere
/// thus reaches no others.
std::optional<std::filesystem::path> side_file(const std::filesystem::path& main,
                                               const std::filesystem::path& name);

}  // namespace surf::io
