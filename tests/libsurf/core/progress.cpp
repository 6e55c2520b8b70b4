// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/progress.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {

TEST(Watch, WithoutAnyoneDoesNothing) {
  const Watch nobody;
  EXPECT_NO_THROW(nobody.check());
  EXPECT_NO_THROW(nobody.report(1, 2));
  EXPECT_NO_THROW(nobody.part(0, 1).report(1, 2));
}

TEST(Watch, PartsAreSharesOfTheWhole) {
  std::vector<std::pair<double, double>> told;
  const Watch part =
      Watch{[&](double done, double total) { told.emplace_back(done, total); }}.part(0.5, 1).part(
          0, 0.5);
  part.report(0, 8);
  part.report(4, 8);
  part.report(8, 8);
  EXPECT_EQ(told, (std::vector<std::pair<double, double>>{{0.5, 1}, {0.625, 1}, {0.75, 1}}));
}

TEST(Watch, ATokenEndsTheWork) {
  CancelToken token;
  const Watch watch{{}, &token};
  watch.part(0, 1).report(1, 2);
  token.cancel();
  EXPECT_THROW(watch.check(), Interrupted);
  EXPECT_THROW(watch.part(0, 1).report(1, 2), Interrupted);
}

TEST(WatchedParallelFor, TellsFromTheCallingThreadAlone) {
  for (const int threads : {1, 4}) {
    const std::thread::id caller = std::this_thread::get_id();
    double last = 0;
    std::size_t calls = 0;
    const auto work = [](std::size_t, int) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    };
    parallel_for(50, threads, work, {[&](double done, double total) {
                   EXPECT_EQ(std::this_thread::get_id(), caller);
                   EXPECT_EQ(total, 50);
                   EXPECT_GT(done, last);
                   last = done;
                   ++calls;
                 }});
    EXPECT_LE(last, 50);
    if (threads == 1) {
      EXPECT_EQ(calls, 50u);
    }
  }
}

TEST(WatchedParallelFor, StopsWhenTheTokenIsSet) {
  for (const int threads : {1, 4}) {
    CancelToken token;
    std::atomic<int> done{0};
    EXPECT_THROW(parallel_for(1000, threads,
                              [&](std::size_t unit, int) {
                                ++done;
                                if (unit == 10) token.cancel();
                              },
                              {{}, &token}),
                 Interrupted);
    EXPECT_LT(done, 1000);
  }
}

}  // namespace surf
