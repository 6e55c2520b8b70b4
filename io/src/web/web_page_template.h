// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace surf::io {

/// The viewer of web/, bundled into one page, with the marks below where its title and data belong.
/// Empty in a build without Node.js.
std::string_view web_page_template();

inline constexpr std::string_view web_page_title_mark = "<!--semsurf:title-->";
inline constexpr std::string_view web_page_data_mark = "<!--semsurf:data-->";

}  // namespace surf::io
