// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "surf/core/progress.h"

namespace surf {

/// Threads used for `requested` (0 means one per hardware thread). At least 1.
int resolve_threads(int requested);

/// Calls `work(unit, worker)` once for every unit in [0, count). `worker` is in [0, threads) and no
/// two calls with the same worker run at once, so it may index scratch space. Units start in
/// increasing order. The first exception thrown by `work` stops further units and is rethrown.
/// Results must not depend on which worker does a unit: that is the caller's part of "same bytes".
void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t unit, int worker)>& work);

/// The same, watched: told of the units done from the calling thread alone. Throws Interrupted.
void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t unit, int worker)>& work,
                  const Watch& watch);

}  // namespace surf
