// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/flat_yields.h"

#include "specimens.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf::mc {
namespace {

TEST(FlatYields, AreThoseOfASubstrate) {
  const FlatYields y = flat_yields(io::find_material("Au", "test"), 700, 8000);
  const test::Yields direct = test::flat_yields("Au", 700, 0, 8000);
  test::expect_mean(y.se.mean - direct.se.mean,
                    std::hypot(y.se.standard_error, direct.se.standard_error), 0, 2);
  test::expect_mean(y.bse.mean - direct.bse.mean,
                    std::hypot(y.bse.standard_error, direct.bse.standard_error), 0, 2);
  EXPECT_NEAR(y.se.standard_error / direct.se.standard_error, 1, 0.1);
}

TEST(FlatYields, CanBeCancelled) {
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(flat_yields(io::find_material("Si", "test"), 700, 1000, {}, 1, {.cancel = &cancel}),
               Interrupted);
}

}  // namespace
}  // namespace surf::mc
