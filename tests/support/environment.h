// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdlib.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace surf::test {

/// Sets variables, or unsets those whose text is null; undone at the end.
class Environment {
 public:
  Environment(std::initializer_list<std::pair<std::string, const char*>> variables) {
    for (const auto& [name, text] : variables) {
      const char* const old = getenv(name.c_str());
      old_.emplace_back(name, old ? std::optional<std::string>(old) : std::nullopt);
      set(name, text);
    }
  }
  ~Environment() {
    for (const auto& [name, text] : old_) set(name, text ? text->c_str() : nullptr);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  static void set(const std::string& name, const char* text) {
    if (text) setenv(name.c_str(), text, 1);
    else unsetenv(name.c_str());
  }
  std::vector<std::pair<std::string, std::optional<std::string>>> old_;
};

}  // namespace surf::test
