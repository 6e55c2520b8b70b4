// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace surf::io {

/// The file as Gwyddion itself reads it, as the content of a .gwy; nothing where the program is not
/// installed. Runs `gwyddion --convert-to-gwy` in a process of its own, which needs no display; the
/// result is dropped after it is read. Throws FileError with Gwyddion's words where it cannot read
/// it.
std::optional<std::string> convert_by_gwyddion(const std::filesystem::path& path);

}  // namespace surf::io
