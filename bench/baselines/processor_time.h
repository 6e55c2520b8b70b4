// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ctime>

namespace surf::bench {

/// Seconds that all threads of this process have computed: what else the machine does adds nothing.
inline double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

}  // namespace surf::bench
