// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "surf/core/grid.h"

namespace {

using namespace surf;

TEST(LargePages, LeaveWhatMemoryHolds) {
  std::vector<double> values(3 * large_memory_bytes / sizeof(double), 1.5);
  prefer_large_pages(values.data() + 1, (values.size() - 2) * sizeof(double));
  EXPECT_EQ(std::count(values.begin(), values.end(), 1.5),
            static_cast<std::ptrdiff_t>(values.size()));
  prefer_large_pages(nullptr, 0);
}

TEST(LargePages, LargeGridsHoldTheirValue) {
  const Grid<double> grid(1500, 900, 2.5);
  EXPECT_EQ(grid.size(), 1350000U);
  EXPECT_EQ(std::count(grid.data().begin(), grid.data().end(), 2.5), 1350000);
}

}  // namespace
