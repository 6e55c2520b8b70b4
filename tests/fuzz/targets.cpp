// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets.h"

#include <stdexcept>

#include "surf/core/error.h"
#include "target_lists.h"

namespace surf::test {

std::vector<FuzzTarget> fuzz_targets() {
  std::vector<FuzzTarget> all;
  for (const auto& some :
       {mesh_targets(), scan_targets(), picture_targets(), text_targets(), state_targets()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

FuzzTarget fuzz_target(std::string_view name) {
  std::string known;
  for (const FuzzTarget& target : fuzz_targets()) {
    if (target.name == name) return target;
    known += std::string(" ") + target.name;
  }
  throw std::invalid_argument("there is no target '" + std::string(name) + "'; known are" + known);
}

bool is_read(const FuzzTarget& target, const std::string& content, bool go_on) {
  try {
    const Accepted accepted = target.read(content);
    expect_valid(accepted);
    if (go_on) go_on_with(accepted);
    return true;
  } catch (const Error& error) {
    if (error.reason().empty() || error.remedy().empty())
      throw std::logic_error(std::string("an error does not say enough: ") + error.what());
    return false;
  }
}

}  // namespace surf::test
