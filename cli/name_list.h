// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::cli {

/// What stands between commas, empty names too.
std::vector<std::string> parse_names(std::string_view text);

}   // namespace surf::cli
