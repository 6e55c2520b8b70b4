// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace surf::mc {

/// A key of `simulation.physics` and its values, the default first: "elastic" and "mott",
/// "browning".
struct PhysicsWords {
  std::string key;
  std::vector<std::string> values;
};

/// All that `parse_physics` knows.
std::vector<PhysicsWords> physics_words();

}  // namespace surf::mc
