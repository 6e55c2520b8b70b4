// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace surf::io {

/// Whether JSON and XML can hold the text unchanged: UTF-8 (Unicode, table 3-7) without control
/// characters other than tabs and line ends.
bool is_plain_text(std::string_view text);

/// Replaces every byte that cannot be held by U+FFFD. For file names and texts from files, which
/// the user cannot change.
std::string as_plain_text(std::string_view text);

/// Throws InvalidInput if the text is not plain. `what` names the text, as "the name of surface 2".
void check_plain_text(std::string_view text, const std::string& what, const std::string& file);

}  // namespace surf::io
