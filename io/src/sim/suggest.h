// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// The known words, those most like `word` first (fewest letters to change, case apart; of a key
/// such as "density_g_cm3" a part before '_' may be meant).
std::vector<std::string> nearest_first(std::string_view word, std::vector<std::string> known);

/// "a, b, c".
std::string join(const std::vector<std::string>& words);

}  // namespace surf::io
