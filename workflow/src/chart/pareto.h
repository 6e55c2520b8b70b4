// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace surf::workflow {

struct Trade {
  double time = 0, error = 0;
};

/// Those that no other beats in one without being worse in the other: numbers into `trades`, in the
/// order of time. Of equal ones the first. What is not finite is left out.
std::vector<std::size_t> pareto_front(const std::vector<Trade>& trades);

}  // namespace surf::workflow
