// SPDX-License-Identifier: GPL-3.0-or-later
#include "name_list.h"

#include <algorithm>

namespace surf::cli {

std::vector<std::string> parse_names(std::string_view text) {
  std::vector<std::string> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    out.emplace_back(text.substr(from, comma - from));
    from = comma + 1;
  }
  return out;
}

}   // namespace surf::cli
