// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_preparation.h"

#include <gmock/gmock.h>

#include "hilly_pair.h"

namespace surf::workflow {
namespace {

using testing::Contains;
using testing::HasSubstr;

class PrepareSem : public HillyPair {
 protected:
  PrepareSem() {
    job_.tilt.reset();
    summary_.afm = prepare_afm(job_.afm->scan, job_.afm->preparation);
    summary_.afm->level_doubt = {2e-3, 2e-3};
    summary_.model = model();
    summary_.pose.emplace();
    summary_.pose->sem_to_afm = shift;
    reporter_.on_warning = [this](const std::string& text) { warnings_.push_back(text); };
  }
  SemTilt tilt() {
    AfmData afm{summary_.afm->image, summary_.afm->tip, summary_.afm->noise, 1, {2e-3, 2e-3}};
    const HeightField before = afm.image;
    prepare_sem(job_, summary_, job_.sem->image, &afm, reporter_);
    moved_ = afm.image.z_nm(70, 50) - before.z_nm(70, 50);
    return summary_.tilt;
  }

  ReconstructSummary summary_;
  Reporter reporter_;
  std::vector<std::string> warnings_;
  double moved_ = 0;
};

TEST_F(PrepareSem, TheSemImageLevelsTheScan) {
  const SemTilt found = tilt();
  EXPECT_GT(found.doubt.x, 0);
  EXPECT_LT(found.doubt.x, 2e-3);
  EXPECT_LT(std::hypot(found.x, found.y), 8e-3);
  EXPECT_THAT(warnings_, testing::Not(Contains(HasSubstr("stays as it was levelled"))));
}

/// A detector at one side makes slopes that face it brighter.
TEST_F(PrepareSem, ATiltThatTheScanExcludesIsNotTaken) {
  PlacedImage& image = job_.sem->image;
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x)
      image.values(x, y) +=
          60 * (truth_.z_nm(x + 13, y + 9) - truth_.z_nm(x + 11, y + 9)) / (2 * pitch);
  const SemTilt found = tilt();
  EXPECT_EQ(found.x, 0);
  EXPECT_EQ(found.y, 0);
  EXPECT_EQ(found.doubt.x, 2e-3);
  EXPECT_NEAR(moved_, 0, 1e-9);
  EXPECT_THAT(warnings_, Contains(HasSubstr("stays as it was levelled")));
}

}  // namespace
}  // namespace surf::workflow
