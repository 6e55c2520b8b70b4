// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "surf/core/progress.h"
#include "surf/mc/simulate.h"

namespace surf::mc {

/// The number of the next unit of work to be simulated, or none when there is no more.
using TakeUnit = std::function<std::optional<std::size_t>()>;

/// What has become of a unit.
using GiveTally = std::function<void(std::size_t unit, const UnitTally& tally)>;

/// Others who simulate units of the same scene with the same options, in other processes. Whoever leads hands out
/// units and gets their tallies; who follows simulates what it is handed.
class Crew {
 public:
  virtual ~Crew() = default;

  /// Whether this process leads. Only one of a crew does.
  virtual bool leads() const = 0;

  /// Hands units to the others until there is no more to take and all that they took has been given, or until `cancel`.
  /// `take` and `give` may be called while others call them. Called by `simulate` on its own thread.
  virtual void lead(const TakeUnit& take, const GiveTally& give, const CancelToken* cancel) = 0;

  /// The other side: has `work` simulate with a `take` that waits for the leader, and a `give` that sends there.
  /// `work` takes on `threads` threads, and returns when `take` has no more. Throws Interrupted on `cancel`, which the
  /// leader takes for a failure unless it is cancelled itself.
  virtual void follow(const std::function<void(const TakeUnit&, const GiveTally&)>& work, int threads,
                      const CancelToken* cancel) = 0;
};

}  // namespace surf::mc
