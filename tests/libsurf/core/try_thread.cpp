// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/try_thread.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>

#include "surf/core/parallel.h"

namespace surf {
namespace {

/// From here on the process gets no more address space than for a little heap: a thread's stack
/// takes more. Stacks that threads have left are used up by threads that wait until the process
/// ends.
void refuse_threads() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t bytes = static_cast<rlim_t>(pages) * 4096 + (1 << 20);
  const rlimit limit{bytes, bytes};
  if (setrlimit(RLIMIT_AS, &limit) != 0) std::_Exit(9);
  for (;;) {
    std::jthread thread = try_thread([] { ::pause(); });
    if (!thread.joinable()) break;
    thread.detach();
  }
  take_refused_threads();
}

[[noreturn]] void end(bool good) { std::_Exit(good ? 0 : 1); }

TEST(TryThread, DoesTheWork) {
  std::atomic<int> done{0};
  {
    const std::jthread thread = try_thread([&] { ++done; });
  }
  EXPECT_EQ(done, 1);
  EXPECT_EQ(take_refused_threads(), 0);
}

TEST(TryThread, IsNotJoinableWhereThreadsAreRefused) {
  EXPECT_EXIT(
      {
        refuse_threads();
        const bool started = try_thread([] {}).joinable();
        end(!started && take_refused_threads() == 1 && take_refused_threads() == 0);
      },
      testing::ExitedWithCode(0), "");
}

TEST(TryThread, LoopsAreDoneByFewerThreads) {
  EXPECT_EXIT(
      {
        std::atomic<int> done{0};
        refuse_threads();
        parallel_for(100, 8, [&](std::size_t, int worker) { done += worker == 0 ? 1 : 1000; });
        end(done == 100 && take_refused_threads() == 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace surf
