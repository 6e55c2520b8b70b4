// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/instruction_set.h"

#include <gmock/gmock.h>

#include "vector_targets.h"

namespace surf {

// What libsurf is compiled for besides (SVE, which an emulated AArch64 has) would be tried by no
// test that goes through the targets.
TEST(InstructionSet, LoopsAreCompiledForThoseThatAreNamed) {
  const std::vector<std::int64_t> targets = test::vector_targets();
  ASSERT_FALSE(targets.empty());
#if defined(__aarch64__)
  EXPECT_THAT(targets, testing::ElementsAre(HWY_NEON));
  EXPECT_EQ(instruction_set(), "AArch64");
#else
  for (const std::int64_t target : targets)
    EXPECT_TRUE(target & (HWY_AVX3 | HWY_AVX2 | HWY_SSE4 | HWY_EMU128 | HWY_SCALAR))
        << test::name_of_target(target);
#endif
}

}  // namespace surf
