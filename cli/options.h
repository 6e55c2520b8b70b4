// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "surf/io/mesh_unit.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mesh/height_field_mesh.h"

namespace surf::cli {

// Text of the command line to values. All throw UsageError naming `subject`, the option.

/// A whole number in [lowest, highest]; "1e6" is one too.
std::int64_t parse_whole(std::string_view text, std::string_view subject, std::int64_t lowest,
                         std::int64_t highest);

/// A finite number.
double parse_number(std::string_view text, std::string_view subject);

/// Finite numbers, one or more, with commas between them.
std::vector<double> parse_numbers(std::string_view text, std::string_view subject);

/// A seed: any unsigned 64-bit number.
std::uint64_t parse_seed(std::string_view text, std::string_view subject);

/// "256x192", or "256" for a square.
std::pair<int, int> parse_size(std::string_view text, std::string_view subject);

/// "2nm" for square pixels, or "2nmx3nm".
std::pair<double, double> parse_pixel_size(std::string_view text, std::string_view subject);

/// "X0,Y0,X1,Y1".
mc::ScanRequest::Region parse_region(std::string_view text, std::string_view subject);

/// What --unit and --override-unit say of mesh files. Throws UsageError for the one without the other.
io::MeshUnit parse_mesh_unit(const std::optional<std::string>& unit, bool overrides);

/// The length of a file's unit in nm: "um", or "25.4mm".
double parse_unit_nm(std::string_view text, std::string_view subject);

Edge parse_edge(std::string_view text, std::string_view subject);

/// The candidate that `word` was most likely meant to be; empty if none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace surf::cli
