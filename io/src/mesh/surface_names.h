// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <string>
#include <utility>

namespace surf::io {

/// Makes names unique: "tip", "tip 2", "tip 3", with `gap` before the number.
class UniqueNames {
 public:
  explicit UniqueNames(std::string gap = " ") : gap_(std::move(gap)) {}

  std::string operator()(const std::string& name) {
    std::string candidate = name;
    for (int number = 2; !given_.insert(candidate).second; ++number) {
      candidate = name + gap_ + std::to_string(number);
    }
    return candidate;
  }

 private:
  std::string gap_;
  std::set<std::string> given_;
};

}  // namespace surf::io
