// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/random.h"

#include <stdexcept>
#include <vector>

#include "statistics.h"

namespace surf {

TEST(RandomStream, GivesPhiloxsPublishedNumbers) {
  // Known answer of Philox4x32-10 for counter 0, key 0 (Random123's kat_vectors).
  RandomStream random(0, 0, 0);
  EXPECT_EQ(random.bits(), 0x6627e8d5u);
  EXPECT_EQ(random.bits(), 0xe169c58du);
  EXPECT_EQ(random.bits(), 0xbc57ac4cu);
  EXPECT_EQ(random.bits(), 0x9b00dbd8u);
}

TEST(RandomStream, IsAFunctionOfItsKeyAlone) {
  RandomStream a(7, 123456789012, 98765432109), b(7, 123456789012, 98765432109);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(a.bits(), b.bits());
}

TEST(RandomStream, DiffersWithEachPartOfTheKey) {
  const std::vector<RandomStream> streams{{1, 2, 3},
                                          {2, 2, 3},
                                          {1, 3, 3},
                                          {1, 2, 4},
                                          {1, 2 + (1ull << 32), 3},
                                          {1, 2, 3 + (1ull << 32)},
                                          {1 + (1ull << 32), 2, 3}};
  std::vector<std::uint32_t> first;
  for (RandomStream s : streams) first.push_back(s.bits());
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(first[i], first[j]) << i << " " << j;
}

TEST(RandomStream, RefusesKeysThatWouldCollide) {
  EXPECT_THROW(RandomStream(1, 1ull << 48, 0), std::out_of_range);
  EXPECT_THROW(RandomStream(1, 0, 1ull << 48), std::out_of_range);
}

TEST(RandomStream, IsUniformAcrossStreams) {
  // The first numbers of neighbouring pixels and electrons: what images are made of.
  std::vector<std::int64_t> counts(100);
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    RandomStream random(1, static_cast<std::uint64_t>(i % 400),
                        static_cast<std::uint64_t>(i / 400));
    const double u = random.uniform();
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    ++counts[static_cast<std::size_t>(u * 100)];
  }
  test::expect_distributed(counts, std::vector<double>(100, n / 100.0));
}

}  // namespace surf
