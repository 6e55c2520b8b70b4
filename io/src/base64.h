// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace surf::io {

/// Decodes base64 (RFC 4648) with or without padding; blanks and line ends are skipped. Nothing for
/// text that is not base64.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace surf::io
