// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// Rows of numbers as programs export them, and the text around them.
struct NumberTable {
  std::vector<std::string_view>
      header;                  ///< lines of text before the numbers, and comments anywhere
  std::vector<double> values;  ///< row after row as the file has them; NaN where it says so
  std::size_t columns = 0, rows = 0;
};

/// Blanks, tabs, semicolons or commas separate; commas are decimal points where something else
/// separates, no number has a point and no comma ends a word. Lines that begin with # or % are
/// comments. Throws FileError, naming the line, where there are no numbers, rows differ in length,
/// or text follows numbers.
NumberTable parse_number_table(const std::string& file, std::string_view content);

}  // namespace surf::io
