// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace surf::io {

/// Compressed in zlib's format (RFC 1950), which PNG and browsers know as "deflate". The same bytes
/// give the same bytes with the same zlib.
std::string deflate(std::string_view bytes);

}  // namespace surf::io
