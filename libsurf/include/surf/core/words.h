// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace surf {

/// Splits `text` at every character of `separators`; n separators give n + 1 parts, which may be
/// empty. The parts point into `text`.
std::vector<std::string_view> split(std::string_view text, std::string_view separators);

/// Levenshtein's distance: the number of letters to insert, remove or replace.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The words of a command, quoted for a shell.
std::string quoted_command(const std::vector<std::string>& words);

}  // namespace surf
