// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace surf::io {

/// The largest number of parts in one key: "beam.energy" has two. Together with toml++'s limit of
/// 256 nested values this bounds the depth of its recursion.
inline constexpr int most_key_parts = 32;

/// Throws FileError with line and column if a key of the TOML text has more parts: in a line of its
/// own, in the head of a table or within braces. Dots in texts and comments do not count.
void check_key_depth(std::string_view text, const std::string& file);

}  // namespace surf::io
