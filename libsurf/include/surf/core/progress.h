// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>

namespace surf {

/// Reports the progress of a long computation, from one thread at a time. `done` of `total` units
/// of work are finished; each computation has its own unit.
using ProgressCallback = std::function<void(double done, double total)>;

/// A flag that long computations poll between units of work. Safe to set from a signal handler.
class CancelToken {
 public:
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> cancelled_{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "needed inside signal handlers");
};

/// Progress and cancellation of a long computation. A cancelled function throws `Interrupted`
/// (error.h), unless a partial result is useful: then the summary says that the result is not
/// complete. Functions that report no progress take only the token.
struct Watch {
  ProgressCallback progress;            ///< may be empty
  const CancelToken* cancel = nullptr;  ///< may be null

  bool cancelled() const { return cancel && cancel->cancelled(); }
  /// Throws Interrupted if the token is set.
  void check() const;
  /// Calls `check`, then `progress`.
  void report(double done, double total) const;
  /// The watch for a part of the work: progress from 0 to 1 of the part is reported as progress
  /// from `from` to `to` (both in [0, 1]) of the whole.
  Watch part(double from, double to) const;
};

}  // namespace surf
