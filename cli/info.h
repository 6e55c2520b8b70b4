// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "surf/core/vec3.h"
#include "surf/io/mesh_unit.h"

namespace surf::cli {

/// "    label      value", as every line of `info` looks.
void print_item(const std::string& label, const std::string& value);

/// "x -50 to 50, y ..., z ... nm" and "100 nm x 100 nm x 40 nm".
std::string format_bounds(const Box& box);
std::string format_extent(const Box& box);

/// Without a unit: as the format says, else nm.
void print_mesh(const std::filesystem::path& path, const io::MeshUnit& unit);
void print_image(const std::filesystem::path& path);
void print_model(const std::filesystem::path& path);
/// What a microscope wrote: surf/io/sem_file.h.
void print_sem_image(const std::filesystem::path& path);
void print_height_file(const std::filesystem::path& path);

}  // namespace surf::cli
