// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "surf/core/affine.h"

namespace surf::io {

/// The content of a transform file.
struct TransformFile {
  Affine sem_to_afm;
  bool verified = true;                      ///< false: the registration should not be trusted
  std::string verdict;                       ///< in words; empty if a person wrote the file
  std::map<std::string, std::string> notes;  ///< how the transform was made
};

/// Writes JSON: {"semsurf": "transform", "version": 1, "sem_to_afm": [xx, xy, x0, yx, yy, y0],
/// "verified": true ...}, lengths in nm: x_afm = xx x_sem + xy y_sem + x0, and y alike. Throws
/// FileError.
void write_transform(const std::filesystem::path& path, const TransformFile& file);

/// Reads such a file, exact to the last digit. `verified`, `verdict` and `notes` may be missing.
/// Throws FileError naming the place of a fault; a map that cannot be inverted is one.
TransformFile read_transform(const std::filesystem::path& path);

}  // namespace surf::io
