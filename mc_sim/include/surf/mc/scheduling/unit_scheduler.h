// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <optional>

#include "surf/core/progress.h"
#include "surf/mc/results/unit_tally.h"

namespace surf::mc {

/// The number of the next unit of work to be simulated, or none when there is no more.
using TakeUnit = std::function<std::optional<std::size_t>()>;

/// The units of a simulation, and what to do with them. Its functions may be called from several
/// threads at once.
struct UnitWork {
  int threads = 1;  ///< to be used in this process
  TakeUnit take;    ///< no unit is given twice; only where the scheduler `collects`
  /// Simulates a unit on one of the threads, which are numbered from 0. False when it was
  /// cancelled: the unit is left out.
  std::function<bool(std::size_t number, int thread, UnitTally& tally)> simulate;
  /// Takes a finished unit, whoever simulated it; only where the scheduler `collects`.
  std::function<void(std::size_t number, const UnitTally& tally)> finish;
  const CancelToken* cancel = nullptr;
};

/// Decides who simulates which units: threads of this process, or those of others besides. The
/// result does not depend on it.
class UnitScheduler {
 public:
  virtual ~UnitScheduler() = default;

  /// Whether finished units come to this process, which then has the result. They come to one
  /// process only.
  virtual bool collects() const = 0;

  /// Has all units simulated, and returns when this process has no more to do. Throws what a
  /// function of `work` has thrown.
  virtual void run(const UnitWork& work) = 0;

  /// Called in place of `run` where this process cannot take part, so that others do not wait for
  /// it. `reason`: null when it was cancelled.
  virtual void abandon(const std::exception_ptr& reason, const CancelToken* cancel) = 0;
};

/// Threads of this process, alone. Each takes the next unit as soon as it has finished one.
class ThreadScheduler final : public UnitScheduler {
 public:
  bool collects() const override { return true; }
  void run(const UnitWork& work) override;
  void abandon(const std::exception_ptr&, const CancelToken*) override {}
};

}  // namespace surf::mc
