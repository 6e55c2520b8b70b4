// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>

namespace surf {

/// Called now and then by long work, from one thread at a time.
/// `done` of `total` units of work are finished; both are counted in the work's own unit.
using ProgressCallback = std::function<void(double done, double total)>;

/// A flag that long work looks at between units of work. Safe to set from a signal handler.
class CancelToken {
 public:
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> cancelled_{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "needed inside signal handlers");
};

/// Who watches work that has nothing to show before it is done: told how far it is, and able to end it,
/// which leaves it by `Interrupted` (error.h).
struct Watch {
  ProgressCallback progress;             ///< or nobody is told
  const CancelToken* cancel = nullptr;   ///< or nobody can end it

  /// Throws Interrupted if the token is set.
  void check() const;
  /// `check`, and tells.
  void report(double done, double total) const;
  /// For a part of the work: all of it is told as `from` to `to`, in [0, 1].
  Watch part(double from, double to) const;
};

}  // namespace surf
