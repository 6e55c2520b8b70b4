// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// Splits one line of a CSV table into its fields, at least one. Commas between quotation marks
/// belong to the field. Quotation marks and carriage returns are left out. Every line is accepted.
std::vector<std::string> split_csv_line(std::string_view line);

}  // namespace surf::io
