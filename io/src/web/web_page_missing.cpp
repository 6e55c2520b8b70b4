// SPDX-License-Identifier: GPL-3.0-or-later
// The viewer in a build without Node.js.
#include "web_page_template.h"

namespace surf::io {

std::string_view web_page_template() { return {}; }

}  // namespace surf::io
