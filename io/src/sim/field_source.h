// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/height_field.h"

namespace surf::io {

/// A height field in a file, and what the file may not say.
struct FieldSource {
  std::filesystem::path path;
  std::string channel;                             ///< empty: the first of heights
  std::optional<double> pitch_x_nm, pitch_y_nm;    ///< in place of the file's; the field's middle is then at (0, 0)
  std::optional<double> unit_nm;                   ///< of one unit of height
};

/// Reads a scan, or an image of heights. What had to be assumed is added to `notes`, under the name `called`. Throws UsageError
/// that names "specimen.height_channel", FileError, InvalidInput.
HeightField read_field(const FieldSource& source, const std::string& called, std::vector<std::string>& notes);

}  // namespace surf::io
