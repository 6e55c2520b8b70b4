// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace surf::io {

/// Converts a file by Gwyddion and returns the content of a .gwy file, or nothing if Gwyddion is
/// not installed. Runs `gwyddion --convert-to-gwy` in a process of its own, which needs no display.
/// The converted file is deleted after reading. Throws FileError with Gwyddion's message if
/// Gwyddion cannot read the file.
std::optional<std::string> convert_by_gwyddion(const std::filesystem::path& path);

}  // namespace surf::io
