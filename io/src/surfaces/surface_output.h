// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "known_formats.h"

namespace surf::io {

/// The output format by extension. Throws UsageError for an unknown one, Unsupported if it needs
/// VTK.
NamedFormat written_format(const std::filesystem::path& path);

/// Writes a valid scene and returns the names of its files, the main one first. All files are
/// complete under temporary names before the first is renamed; the main one is renamed last. Throws
/// InvalidInput if numbers do not fit the format, UsageError if one of the other files would
/// replace a stranger (`refuse_strangers`).
std::vector<std::filesystem::path> write_view(const std::filesystem::path& path, SceneView scene);

}  // namespace surf::io
