// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/random_streams.h"

#include <gtest/gtest.h>

#include <set>

namespace surf::mc {

// An electron that is handed over once had the stream of the order of cascades, and from the 128th
// on none at all.
TEST(RandomStreams, OfAPixelAreEachSomebodys) {
  using namespace random_streams;
  std::set<std::uint64_t> taken{dose, shot_noise, shot_noise + 1, shot_noise + most_electrons - 1,
                                order_of_cascades};
  const std::size_t others = taken.size();
  std::size_t handed = 0;
  for (const std::uint64_t electron : {std::uint64_t{0}, std::uint64_t{1}, most_electrons - 1})
    for (const std::uint64_t count :
         {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{127},
          std::uint64_t{128}, most_handed_over - 1}) {
      const std::uint64_t stream = handed_over(electron, count);
      EXPECT_TRUE(taken.insert(stream).second);
      EXPECT_GE(stream, most_electrons);
      EXPECT_NO_THROW(RandomStream(1, 0, stream));
      ++handed;
    }
  EXPECT_EQ(taken.size(), others + handed);
}

}  // namespace surf::mc
