// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweeps.h"

#include <vector>

#include "sweep.h"

namespace surf::limits {

std::span<const Sweep> sweeps() {
  static const std::vector<Sweep> all{
      energy_range(),
  };
  return all;
}

}  // namespace surf::limits
