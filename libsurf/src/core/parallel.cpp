// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/parallel.h"

#if defined(__linux__)
#include <sched.h>
#endif

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/try_thread.h"

namespace surf {
namespace {

/// Hands out the units of one parallel_for and keeps its error.
class Queue {
 public:
  Queue(std::size_t count, const std::function<void(std::size_t, int)>& work)
      : count_(count), work_(work) {}

  void run(int worker) {
    while (!stop_.load(std::memory_order_relaxed)) {
      const std::size_t unit = next_.fetch_add(1, std::memory_order_relaxed);
      if (unit >= count_) return;
      try {
        work_(unit, worker);
      } catch (...) {
        fail(unit);
      }
    }
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  // A unit that was handed out always runs. So the lowest failing unit, and hence the message, is
  // the same for any number of threads.
  void fail(std::size_t unit) {
    const std::lock_guard lock(mutex_);
    if (!error_ || unit < failed_unit_) {
      error_ = std::current_exception();
      failed_unit_ = unit;
    }
    stop_.store(true, std::memory_order_relaxed);
  }

  const std::size_t count_;
  const std::function<void(std::size_t, int)>& work_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
  std::size_t failed_unit_ = 0;
};

}  // namespace

int resolve_threads(int requested) {
  if (requested < 0) {
    throw UsageError("threads", "it is " + std::to_string(requested),
                     "Give 1 or more, or 0 for one per hardware thread");
  }
  if (requested > 0) return requested;
#if defined(__linux__)
  // MPI launchers and batch systems may restrict a process to a part of the processors.
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0 && CPU_COUNT(&allowed) > 0)
    return CPU_COUNT(&allowed);
#endif
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t, int)>& work) {
  const int workers =
      static_cast<int>(std::min(count, static_cast<std::size_t>(resolve_threads(threads))));
  Queue queue(count, work);
  {
    std::vector<std::jthread> others;
    others.reserve(static_cast<std::size_t>(workers));
    for (int worker = 1; worker < workers; ++worker) {
      std::jthread other = try_thread([&queue, worker] { queue.run(worker); });
      if (!other.joinable()) break;  // the threads that were started do all the work
      others.push_back(std::move(other));
    }
    queue.run(0);
  }
  queue.rethrow();
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, int)>& work,
                  const Watch& watch) {
  std::atomic<std::size_t> done{0};
  parallel_for(count, threads, [&](std::size_t unit, int worker) {
    watch.check();
    work(unit, worker);
    const std::size_t so_far = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (worker == 0) watch.report(static_cast<double>(so_far), static_cast<double>(count));
  });
}

}  // namespace surf
