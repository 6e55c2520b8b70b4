// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace surf::io {

/// The viewer of web/, bundled into one page, with the marks below in place of its title and data.
/// Empty in a build without Node.js.
std::string_view web_page_template();

inline constexpr std::string_view web_page_title_mark = "<!--semsurf:title-->";
inline constexpr std::string_view web_page_data_mark = "<!--semsurf:data-->";

}  // namespace surf::io
