// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "surf/core/progress.h"

namespace surf::mc {

/// The number of the next unit of work to be simulated, or none when there is no more.
using TakeUnit = std::function<std::optional<std::size_t>()>;

/// What has become of a unit, as whoever leads and whoever follows have agreed to write it.
struct FinishedUnit {
  std::size_t number = 0;
  std::int64_t primaries = 0;   ///< simulated for it
  std::string bytes;
  int rank = 0;                 ///< who did it; whoever leads is told
};
using GiveUnit = std::function<void(FinishedUnit unit)>;

/// Others who do numbered units of the same work in other processes: of a simulation, parts of the same scene with the
/// same options. Whoever leads hands out units and gets what became of them; who follows does what it is handed.
class UnitScheduler {
 public:
  virtual ~UnitScheduler() = default;

  /// Whether this process leads. Only one of a scheduler does.
  virtual bool leads() const = 0;

  /// Hands units to the others until there is no more to take and all that they took has been given, or until `cancel`.
  /// `take` and `give` may be called while others call them. Called by `simulate` on its own thread.
  virtual void lead(const TakeUnit& take, const GiveUnit& give, const CancelToken* cancel) = 0;

  /// The other side: has `work` go on with a `take` that waits for the leader, and a `give` that sends there.
  /// `work` computes on `threads` threads, and returns when `take` has no more. About `ahead` units are kept here beyond
  /// those at work, so that nobody waits for the next; 0 where a unit is long, and others may be idle by then. Throws
  /// Interrupted on `cancel`, which the leader takes for a failure unless it is cancelled itself.
  virtual void follow(const std::function<void(const TakeUnit&, const GiveUnit&)>& work, int threads, int ahead,
                      const CancelToken* cancel) = 0;
};

}  // namespace surf::mc
