// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace surf {

/// The parts between any of the separators, empty ones too: one more than there are separators.
/// They point into `text`.
std::vector<std::string_view> split(std::string_view text, std::string_view separators);

/// Levenshtein's distance: letters to insert, remove or replace.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The words of a command as a shell reads them.
std::string quoted_command(const std::vector<std::string>& words);

}  // namespace surf
