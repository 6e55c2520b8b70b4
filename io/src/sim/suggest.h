// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// The known words, the most similar to `word` first. The measure is the number of letters to
/// change, ignoring case. In keys such as "density_g_cm3" the word may also match a part before
/// '_'.
std::vector<std::string> nearest_first(std::string_view word, std::vector<std::string> known);

/// "a, b, c".
std::string join(const std::vector<std::string>& words);

}  // namespace surf::io
