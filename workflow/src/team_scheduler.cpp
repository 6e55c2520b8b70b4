// SPDX-License-Identifier: GPL-3.0-or-later
#include "team_scheduler.h"

#include <atomic>

#include "surf/core/error.h"
#include "surf/mc/results/serialize.h"

namespace surf::workflow {

void TeamScheduler::run(const mc::UnitWork& work) {
  if (team_.leads()) lead(work);
  else follow(work);
}

void TeamScheduler::lead(const mc::UnitWork& work) {
  std::atomic<bool> ended = false;  // set by an error on either side
  mc::UnitWork shared = work;
  shared.take = [&] { return ended ? std::nullopt : work.take(); };
  lead_while(
      team_, shared.take,
      [&](const FinishedUnit& unit) { work.finish(unit.number, mc::deserialize(unit.bytes)); },
      work.cancel, [&] { mc::ThreadScheduler().run(shared); }, [&] { ended = true; });
}

void TeamScheduler::follow(const mc::UnitWork& work) {
  team_.follow(
      [&](const TakeUnit& take, const GiveUnit& give) {
        mc::UnitWork handed = work;
        handed.take = take;
        handed.finish = [&](std::size_t number, const mc::UnitTally& tally) {
          give({number, tally.balance.incident, mc::serialize(tally)});
        };
        mc::ThreadScheduler().run(handed);
      },
      work.threads, work.threads, work.cancel);
}

void TeamScheduler::abandon(const std::exception_ptr& reason, const CancelToken* cancel) {
  try {
    if (team_.leads()) {
      team_.lead([] { return std::nullopt; }, [](const FinishedUnit&) {}, cancel);
      return;
    }
    team_.follow(
        [&](const TakeUnit&, const GiveUnit&) {
          if (reason) std::rethrow_exception(reason);
          throw Interrupted();
        },
        1, 0, cancel);
  } catch (...) {  // the caller passes the reason on
  }
}

}  // namespace surf::workflow
