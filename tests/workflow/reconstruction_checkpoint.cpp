// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_checkpoint.h"

#include <gmock/gmock.h>

#include <cmath>

#include "reconstruction_state.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;

TEST(ReconstructionCheckpoint, AStateComesBackToTheLastBit) {
  ReconstructionState state;
  state.surface.z_nm = Grid<double>(3, 2);
  state.surface.z_nm.data() = {1.0 / 3, -0.0, 5e-324, 1e60, 2, 3};
  state.surface.valid = Mask(3, 2, 1);
  state.surface.pitch_x_nm = 0.1;
  state.sem_to_afm = {1, 2, 3, 4, 5, 6};
  state.gains = {0.1, 0.2};
  state.offset = -7;
  state.blur_px2 = 0.3;
  state.film_nm = 1.7;
  state.scan_drift_px = {1.25, -2};
  state.tip_change = {0.25, -0.5};
  state.views = {{{0.5, -1}, {90, 30}, 7}};
  state.scales.resize(2);
  state.scales[1].ended = "converged";
  state.scales[1].products = 12;
  state.scales[1].factors = 40;
  state.scales[1].double_factors = 3;
  state.scales[1].sem_residual.like_noise = false;
  const std::string bytes = pack(state);
  const auto back = unpack(bytes);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(pack(*back), bytes);
  EXPECT_EQ(back->surface.z_nm, state.surface.z_nm);
  EXPECT_TRUE(std::signbit(back->surface.z_nm(1, 0)));
  EXPECT_EQ(back->blur_px2, 0.3);
  EXPECT_EQ(back->film_nm, 1.7);
  EXPECT_EQ(back->scan_drift_px, state.scan_drift_px);
  EXPECT_EQ(back->tip_change, state.tip_change);
  ASSERT_EQ(back->views.size(), 1u);
  EXPECT_EQ(back->views[0].pose_change, state.views[0].pose_change);
  EXPECT_EQ(back->views[0].gains, state.views[0].gains);
  EXPECT_EQ(back->views[0].offset, state.views[0].offset);
  EXPECT_EQ(back->scales[1].ended, "converged");
  EXPECT_EQ(back->scales[1].factors, 40);
  EXPECT_EQ(back->scales[1].double_factors, 3);
  EXPECT_FALSE(back->scales[1].sem_residual.like_noise);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(unpack(bytes.substr(0, size)).has_value()) << size;
  EXPECT_FALSE(unpack(bytes + "x").has_value());
}

TEST(ReconstructionCheckpoint, ACorrectionComesBackToTheLastBit) {
  ModelCorrection correction;
  for (ModelImages* images : {&correction.off, &correction.error}) {
    images->emplace_back(3, 2);
    images->back().data() = {1.0 / 3, -0.0, 5e-324, 1e60, 2, 3};
  }
  correction.mean = {0.7};
  correction.primaries = 1234;
  ModelCorrection other = correction;
  other.primaries = 5;
  const std::string bytes = pack({correction, other});
  const auto back = unpack_corrections(bytes);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(pack(*back), bytes);
  ASSERT_EQ(back->size(), 2u);
  EXPECT_EQ(back->front().off, correction.off);
  EXPECT_EQ(back->back().primaries, 5);
  EXPECT_FALSE(unpack(bytes).has_value());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(unpack_corrections(bytes.substr(0, size)).has_value()) << size;
}

TEST(ReconstructionCheckpoint, GivesBackTheLastStateOfTheSameJob) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint";
  ReconstructionState state;
  state.surface.z_nm = Grid<double>(3, 2);
  {
    ReconstructionCheckpoint checkpoint(file, {{"scan", "a"}}, {});
    EXPECT_FALSE(checkpoint.found().has_value());
    for (const double offset : {1, 2, 3}) {
      state.offset = offset;
      checkpoint.keep(state);
    }
  }
  {
    ReconstructionCheckpoint same(file, {{"scan", "a"}}, {});
    ASSERT_TRUE(same.found().has_value());
    EXPECT_EQ(same.found()->offset, 3);
  }
  std::string said;
  ReconstructionCheckpoint other(file, {{"scan", "b"}},
                                 [&](const std::string& note) { said = note; });
  EXPECT_THAT(said, HasSubstr("scan a there and b here"));
  EXPECT_FALSE(other.found().has_value());
}

}  // namespace
}  // namespace surf::workflow
