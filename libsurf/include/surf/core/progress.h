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

/// The one way in which long work is watched and stopped. A function that is cancelled throws
/// `Interrupted` (error.h), unless what is done so far is of use: then its summary says that it is
/// not complete. What only has to look whether it should stop takes the token alone.
struct Watch {
  ProgressCallback progress;            ///< may be empty
  const CancelToken* cancel = nullptr;  ///< may be null

  bool cancelled() const { return cancel && cancel->cancelled(); }
  /// Throws Interrupted if the token is set.
  void check() const;
  /// Calls `check`, then `progress`.
  void report(double done, double total) const;
  /// The watch to hand to a part of the work: its progress from 0 to 1 is reported as `from` to
  /// `to`, in [0, 1].
  Watch part(double from, double to) const;
};

}  // namespace surf
