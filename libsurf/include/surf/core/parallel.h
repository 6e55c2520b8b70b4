// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "surf/core/progress.h"

namespace surf {

/// The number of threads for `requested`: 0 means one per hardware thread. At least 1.
int resolve_threads(int requested);

/// Calls `work(unit, worker)` once for every unit in [0, count). `worker` is in [0, threads). Two
/// calls with the same worker never run at once, so `worker` may index scratch space. Units start
/// in increasing order. The first exception thrown by `work` stops further units and is rethrown.
/// The result of a unit must not depend on the worker; then the whole result does not depend on the
/// number of threads.
void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t unit, int worker)>& work);

/// As above, with progress and cancellation. Only the calling thread reports progress. Throws
/// Interrupted.
void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t unit, int worker)>& work,
                  const Watch& watch);

}  // namespace surf
