// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "surf/core/error.h"

namespace surf {
namespace {

void pause() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

}  // namespace

TEST(ResolveThreads, ZeroIsOnePerHardwareThread) {
  EXPECT_GE(resolve_threads(0), 1);
  EXPECT_EQ(resolve_threads(1), 1);
  EXPECT_EQ(resolve_threads(17), 17);
  EXPECT_THROW(resolve_threads(-1), UsageError);
}

TEST(ParallelFor, DoesEveryUnitOnce) {
  for (const int threads : {0, 1, 2, 7, 32}) {
    for (const std::size_t count : {0u, 1u, 2u, 31u, 5000u}) {
      std::vector<std::atomic<int>> calls(count);
      parallel_for(count, threads, [&](std::size_t unit, int) { ++calls.at(unit); });
      for (const auto& c : calls) ASSERT_EQ(c, 1);
    }
  }
}

TEST(ParallelFor, WorkersAreExclusiveAndInRange) {
  constexpr int threads = 8;
  std::vector<std::atomic<int>> inside(threads);
  std::atomic<int> violations{0};
  parallel_for(200, threads, [&](std::size_t, int worker) {
    if (worker < 0 || worker >= threads) {
      ++violations;
      return;
    }
    auto& busy = inside[static_cast<std::size_t>(worker)];
    if (busy++ != 0) ++violations;
    pause();
    --busy;
  });
  EXPECT_EQ(violations, 0);
}

TEST(ParallelFor, ReallyRunsSideBySide) {
  // Each unit waits for the other: with one worker this would give up.
  std::atomic<int> arrived{0};
  std::atomic<int> met{0};
  parallel_for(2, 2, [&](std::size_t, int) {
    ++arrived;
    for (int i = 0; i < 50000 && arrived < 2; ++i) pause();
    if (arrived == 2) ++met;
  });
  EXPECT_EQ(met, 2);
}

TEST(ParallelFor, OneThreadKeepsTheOrder) {
  std::vector<std::size_t> order;
  const auto caller = std::this_thread::get_id();
  parallel_for(100, 1, [&](std::size_t unit, int worker) {
    EXPECT_EQ(worker, 0);
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(unit);
  });
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(order.at(i), i);
}

TEST(ParallelFor, EachWorkerSeesIncreasingUnits) {
  constexpr std::size_t threads = 4;
  std::vector<std::vector<std::size_t>> units(threads);
  parallel_for(400, threads, [&](std::size_t unit, int worker) {
    units[static_cast<std::size_t>(worker)].push_back(unit);
  });
  for (const auto& list : units) {
    for (std::size_t i = 1; i < list.size(); ++i) EXPECT_LT(list[i - 1], list[i]);
  }
}

TEST(ParallelFor, RethrowsTheSameErrorForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 8}) {
    std::atomic<std::size_t> started{0};
    try {
      parallel_for(100000, threads, [&](std::size_t unit, int) {
        ++started;
        if (unit >= 20) throw std::runtime_error("unit " + std::to_string(unit));
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "unit 20");
    }
    EXPECT_LE(started, 20u + static_cast<std::size_t>(threads));
  }
}

TEST(ParallelFor, OfSeveralErrorsTheLowestUnitsIsRethrown) {
  std::atomic<bool> second_fails{false};
  try {
    parallel_for(2, 2, [&](std::size_t unit, int) {
      if (unit == 1) second_fails = true;
      for (int i = 0; i < 50000 && !second_fails; ++i) pause();
      if (unit == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      throw std::runtime_error("unit " + std::to_string(unit));
    });
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "unit 0");
  }
}

TEST(ParallelFor, MayBeNested) {
  std::atomic<int> calls{0};
  parallel_for(4, 2,
               [&](std::size_t, int) { parallel_for(10, 2, [&](std::size_t, int) { ++calls; }); });
  EXPECT_EQ(calls, 40);
}

}  // namespace surf
