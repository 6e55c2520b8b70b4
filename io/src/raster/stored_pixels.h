// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace surf::io {

/// zlib expands data at most 1032 times.
inline constexpr double deflate_ratio = 1032;

/// For compressions that are unknown here or have no limit: a ratio beyond that of ordinary images.
inline constexpr double unknown_ratio = 20000;

/// Throws FileError, before memory is allocated, if an image of `pixel_bytes` cannot fit into a
/// file of `file_bytes`, because even the best compression takes `least_bytes`. Small images pass:
/// their reader reports what is wrong.
void require_stored(const std::string& file, double pixel_bytes, double least_bytes,
                    std::uint64_t file_bytes);

}  // namespace surf::io
