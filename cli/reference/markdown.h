// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace surf::cli::reference {

/// Title, how the page is made, and an introduction.
std::string page_head(const std::string& title, const std::string& introduction);

/// Text in a cell of a table.
std::string cell(const std::string& text);
/// The same, as code.
std::string code(const std::string& text);

/// Cells are taken as they are.
std::string table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows);

}  // namespace surf::cli::reference
