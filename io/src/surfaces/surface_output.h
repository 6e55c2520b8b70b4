// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "known_formats.h"

namespace surf::io {

/// The format to write, by extension. Throws UsageError for an unknown one, Unsupported where it
/// needs VTK.
NamedFormat written_format(const std::filesystem::path& path);

/// Writes a valid scene and returns the names of its files, the main one first. All are whole under
/// temporary names before the first is renamed; the main one is renamed last. Throws InvalidInput
/// where its numbers do not fit the format, UsageError where one of the others would replace a
/// stranger (`refuse_strangers`).
std::vector<std::filesystem::path> write_view(const std::filesystem::path& path, SceneView scene);

}  // namespace surf::io
