// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/grid.h"

#include <gtest/gtest.h>

namespace surf {

TEST(Grid, IsRowMajorFromTheLowerLeft) {
  Grid<int> grid(3, 2, 7);
  grid(2, 0) = 1;
  grid(0, 1) = 2;
  EXPECT_EQ(grid.data(), (std::vector<int>{7, 7, 1, 2, 7, 7}));
  EXPECT_EQ(grid.width(), 3);
  EXPECT_EQ(grid.height(), 2);
  EXPECT_EQ(grid.size(), 6u);
}

TEST(Grid, EqualityLooksAtTheShape) {
  EXPECT_EQ(Grid<int>(3, 2), Grid<int>(3, 2));
  EXPECT_NE(Grid<int>(3, 2), Grid<int>(2, 3));
  EXPECT_NE(Grid<int>(3, 2), Grid<int>(3, 2, 1));
  EXPECT_TRUE(Grid<int>().empty());
}

}  // namespace surf
