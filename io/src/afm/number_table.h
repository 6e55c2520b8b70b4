// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// Rows of numbers as programs export them, with the text around them.
struct NumberTable {
  std::vector<std::string_view> header;  ///< lines of text before the numbers, and all comments
  std::vector<double> values;            ///< row by row as in the file; NaN if the file says so
  std::size_t columns = 0, rows = 0;
};

/// Parses a table of numbers. Separators are blanks, tabs, semicolons or commas. Commas are decimal
/// points if there is another separator, no number has a point, and no comma ends a word. Lines
/// that begin with # or % are comments. Throws FileError, naming the line, if there are no numbers,
/// rows differ in length, or text follows numbers.
NumberTable parse_number_table(const std::string& file, std::string_view content);

}  // namespace surf::io
