// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// The fields of one line of a table (CSV), one at least. Commas between quotation marks belong to
/// the field; the marks themselves and carriage returns are left out. Nothing is an error.
std::vector<std::string> split_csv_line(std::string_view line);

}  // namespace surf::io
