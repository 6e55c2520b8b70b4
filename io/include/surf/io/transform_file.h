// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "surf/core/affine.h"

namespace surf::io {

/// What a file of a transform holds.
struct TransformFile {
  Affine sem_to_afm;
  bool verified = true;                      ///< false: a registration that should not be trusted
  std::string verdict;                       ///< in words; empty where a person wrote the file
  std::map<std::string, std::string> notes;  ///< how it was made
};

/// Writes JSON: {"semsurf": "transform", "version": 1, "sem_to_afm": [xx, xy, x0, yx, yy, y0],
/// "verified": true ...}, lengths in nm: x_afm = xx x_sem + xy y_sem + x0, and y alike. Throws
/// FileError.
void write_transform(const std::filesystem::path& path, const TransformFile& file);

/// Reads it again, to the last digit; all but the six numbers may be missing. Throws FileError
/// naming the place of a fault: a map that cannot be turned back is one.
TransformFile read_transform(const std::filesystem::path& path);

}  // namespace surf::io
