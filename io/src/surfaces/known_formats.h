// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "mesh/mesh_format.h"

namespace surf::io {

std::span<const MeshFormat* const> known_formats();

/// The format by content if the content identifies it, else by name; null if unknown.
const MeshFormat* format_of(const std::filesystem::path& path, std::string_view content);

/// A format under one of its extensions.
struct NamedFormat {
  const MeshFormat* format = nullptr;  ///< null: no format has that extension
  const SurfaceFormat* form = nullptr;
};
NamedFormat format_named(const std::filesystem::path& path);

}  // namespace surf::io
