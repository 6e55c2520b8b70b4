// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/io/height_field_file.h"

namespace surf::io {

/// A file of a height field, and data that the file may not state. A given pitch replaces the
/// file's; the field's middle is then at (0, 0).
struct FieldSource {
  std::filesystem::path path;
  HeightReadOptions options;
};

/// Reads a scan, or an image of heights. Assumptions are added to `notes`, under the name `called`.
/// Throws UsageError that names "scan.height_channel", FileError, InvalidInput.
HeightField read_field(const FieldSource& source, const std::string& called,
                       std::vector<std::string>& notes);

}  // namespace surf::io
