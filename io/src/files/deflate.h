// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace surf::io {

/// Compresses bytes in zlib's format (RFC 1950), which PNG and browsers call "deflate". With the
/// same zlib, equal input gives equal output.
std::string deflate(std::string_view bytes);

}  // namespace surf::io
