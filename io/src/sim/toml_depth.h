// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace surf::io {

/// The most parts that one key may have: "beam.energy" has two. Together with toml++'s limit of 256
/// values within each other this bounds how deep its recursion goes.
inline constexpr int most_key_parts = 32;

/// Throws FileError with line and column where a key of the TOML text has more parts, in a line of
/// its own, in the head of a table or within braces. Dots in texts and comments do not count.
void check_key_depth(std::string_view text, const std::string& file);

}  // namespace surf::io
