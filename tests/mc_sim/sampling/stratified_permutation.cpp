// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/stratified_permutation.h"

#include <set>
#include <utility>

#include <gtest/gtest.h>

#include <vector>

#include "surf/core/random.h"

namespace surf::mc {
namespace {

constexpr std::uint64_t runs[] = {StratifiedPermutation::long_run, 4,
                                  StratifiedPermutation::short_run};

TEST(StratifiedPermutation, TakesEachCascadeOnceBeforeAnyTwice) {
  for (const std::uint64_t cascades : {64u, 128u, 1024u, 64u * 17u}) {
    for (const std::uint64_t run : runs) {
      const StratifiedPermutation subset(cascades, 123456789, 987654321, run);
      for (const std::uint64_t round : {0, 1, 2}) {
        std::set<std::size_t> taken;
        for (std::uint64_t i = round * cascades; i < (round + 1) * cascades; ++i)
          taken.insert(subset[i]);
        EXPECT_EQ(taken.size(), cascades) << run;
        EXPECT_EQ(*taken.rbegin(), cascades - 1);
      }
    }
  }
}

// Block by block are the same pairs of primary and cascade, each once, wherever the range begins.
TEST(StratifiedPermutation, GivesTheSamePrimariesBlockByBlock) {
  struct Range {
    std::uint64_t first, end;
  };
  for (const std::uint64_t cascades : {64u, 128u, 320u, 64u * 17u})
    for (const std::uint32_t a : {0u, 1u, 77u, 0xffffffffu})
      for (const Range r :
           {Range{0, 0}, Range{0, 1}, Range{0, 31}, Range{0, 400}, Range{17, 18}, Range{31, 33},
            Range{100, 1000}, Range{cascades, 3 * cascades + 5}, Range{1000001, 1003000}}) {
        for (const std::uint64_t run : runs) {
          const StratifiedPermutation subset(cascades, a, 3 * a + 5, run);
          std::set<std::uint64_t> served;
          for (std::uint64_t b = 0; b < cascades / StratifiedPermutation::block; ++b)
            subset.each_of_block(b, r.first, r.end, [&](std::uint64_t i, std::size_t cascade) {
              EXPECT_TRUE(served.insert(i).second) << i << " is served twice";
              EXPECT_EQ(cascade, subset[i]) << i << " of " << cascades;
              EXPECT_EQ(cascade / StratifiedPermutation::block, b) << i;
              EXPECT_TRUE(i >= r.first && i < r.end) << i << " of " << r.first << " to " << r.end;
            });
          EXPECT_EQ(served.size(), r.end - r.first)
              << r.first << " to " << r.end << " of " << cascades << " in runs of " << run;
        }
      }
}

TEST(StratifiedPermutation, IsEachPixelsOwn) {
  const StratifiedPermutation one(64 * 100, 5, 7), other(64 * 100, 6, 7), third(64 * 100, 5, 8);
  EXPECT_NE(one[0], other[0]);
  int different = 0;
  for (std::uint64_t i = 0; i < 6400; i += StratifiedPermutation::long_run)
    different += one[i] != third[i];
  EXPECT_GT(different, 50);
}

// Pixels that share one cascade must not share others for that reason, or their noise goes
// together.
TEST(StratifiedPermutation, PixelsShareCascadesByChanceOnly) {
  constexpr std::uint64_t cascades = 16384, primaries = 32, pixels = 400;
  RandomStream random(5, 1, 0);
  std::vector<std::set<std::size_t>> taken(pixels);
  for (auto& own : taken) {
    const std::uint32_t a = random.bits(), b = random.bits();
    const StratifiedPermutation subset(cascades, a, b, StratifiedPermutation::short_run);
    for (std::uint64_t i = 0; i < primaries; ++i) own.insert(subset[i]);
  }
  double pairs = 0, shared = 0, twice = 0;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t k = 0; k < i; ++k) {
      double both = 0;
      for (const std::size_t cascade : taken[i]) both += double(taken[k].count(cascade));
      pairs += 1, shared += both, twice += both * (both - 1);
    }
  EXPECT_NEAR(shared / pairs, double(primaries * primaries) / cascades, 0.006);
  // A quarter of the pairs have blocks in common, of which each is shared by 1 in 64.
  EXPECT_LT(twice / pairs, 0.05);
}

}  // namespace
}  // namespace surf::mc
