// SPDX-License-Identifier: GPL-3.0-or-later
#include "markdown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace surf::cli::reference {

std::string page_head(const std::string& title, const std::string& introduction) {
  return fmt::format(
      "# {}\n\n<!-- Made by the program: cmake --build build --target reference "
      "-->\n\n{}\n\n",
      title, introduction);
}

std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '<') out += '\\';
    out += c;
  }
  return out;
}

std::string code(const std::string& text) {
  std::string out = "`";
  for (const char c : text) {
    if (c == '|') out += '\\';  // ends a cell even within code
    out += c;
  }
  return out + "`";
}

std::string table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows) {
  std::string text = fmt::format("| {} |\n|", fmt::join(heads, " | "));
  for (std::size_t i = 0; i < heads.size(); ++i) text += "---|";
  text += "\n";
  for (const auto& row : rows) text += fmt::format("| {} |\n", fmt::join(row, " | "));
  return text;
}

}  // namespace surf::cli::reference
