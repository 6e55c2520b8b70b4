// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace surf::io {

/// zlib makes nothing larger than 1032 times.
inline constexpr double deflate_ratio = 1032;

/// For compressions that are not known here, or have no limit: more than ordinary images ever come
/// to.
inline constexpr double unknown_ratio = 20000;

/// Throws FileError, before memory is taken, where an image of `pixel_bytes` cannot be in a file of
/// `file_bytes`: with the best compression it takes `least_bytes`. Small images pass: their reader
/// says what is wrong.
void require_stored(const std::string& file, double pixel_bytes, double least_bytes,
                    std::uint64_t file_bytes);

}  // namespace surf::io
