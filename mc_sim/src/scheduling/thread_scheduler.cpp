// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>

#include "surf/core/parallel.h"
#include "surf/mc/scheduling/unit_scheduler.h"

namespace surf::mc {

void ThreadScheduler::run(const UnitWork& work) {
  std::atomic<bool> failed = false;  // on one thread: the others take no more
  parallel_for(static_cast<std::size_t>(work.threads), work.threads, [&](std::size_t, int thread) {
    try {
      while (!failed) {
        const auto number = work.take();
        if (!number) return;
        UnitTally tally;
        if (!work.simulate(*number, thread, tally)) return;
        work.finish(*number, tally);
      }
    } catch (...) {
      failed = true;
      throw;
    }
  });
}

}  // namespace surf::mc
