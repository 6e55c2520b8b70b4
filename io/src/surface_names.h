// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <string>

namespace surf::io {

/// Gives names that were not given before: "tip", "tip 2", "tip 3".
class UniqueNames {
 public:
  std::string operator()(const std::string& name) {
    std::string candidate = name;
    for (int number = 2; !given_.insert(candidate).second; ++number) {
      candidate = name + " " + std::to_string(number);
    }
    return candidate;
  }

 private:
  std::set<std::string> given_;
};

/// The nearest name that a scalar may have: "_HEIGHT NM" becomes "height_nm".
inline std::string scalar_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool is_upper = c >= 'A' && c <= 'Z';
    const bool is_letter = is_upper || (c >= 'a' && c <= 'z');
    if (name.empty() && !is_letter) continue;   // a letter comes first
    const bool is_digit = c >= '0' && c <= '9';
    name += is_upper ? static_cast<char>(c - 'A' + 'a') : is_letter || is_digit ? c : '_';
  }
  return name.empty() ? "value" : name;
}

}  // namespace surf::io
