// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace surf::io {

/// Whether JSON and XML can hold the text as it is: UTF-8 (Unicode, table 3-7) without control
/// characters but tabs and ends of lines.
bool is_plain_text(std::string_view text);

/// The same with U+FFFD in place of every byte that cannot be held: for names of files and what
/// they say, which nobody can change for the sake of the file that is written.
std::string as_plain_text(std::string_view text);

/// Throws InvalidInput for text that is not: `what` says which, as "the name of surface 2".
void check_plain_text(std::string_view text, const std::string& what, const std::string& file);

}  // namespace surf::io
