// SPDX-License-Identifier: GPL-3.0-or-later
#include "judge_places.h"

#include <cmath>

#include "hilly_pair.h"
#include "reconstruction_output.h"
#include "surf/afm/morphology.h"
#include "surf/io/transform_file.h"

namespace surf::workflow {
namespace {

constexpr Affine elsewhere{1, 0, 110, 0, 1, 20};

/// The images of HillyPair with a registration that hesitates between two places.
class JudgePlaces : public HillyPair {
 protected:
  JudgePlaces() {
    job_.tilt.reset();
    summary_.afm = prepare_afm(job_.afm->scan, job_.afm->preparation);
    summary_.model = model();
    afm_ = {summary_.afm->image, summary_.afm->tip, summary_.afm->noise, job_.upsample, {}};
  }

  void hesitate(const Affine& found, const Affine& rival) {
    summary_.pose.emplace();
    summary_.pose->sem_to_afm = found;
    summary_.pose->registration.emplace();
    summary_.pose->registration->verdict = RegistrationVerdict::ambiguous;
    summary_.pose->registration->rivals = {{rival, 0.9, 12}};
  }

  ReconstructSummary summary_;
  AfmData afm_;
};

TEST_F(JudgePlaces, TheSurfaceThatExplainsBothImagesSaysWhichPlaceIsMeant) {
  hesitate(elsewhere, shift);
  EXPECT_FALSE(summary_.pose->verified());
  judge_places(job_, summary_, job_.sem->image, afm_, {});
  EXPECT_NEAR(summary_.pose->sem_to_afm.x0, shift.x0, 0.5 * pitch);
  EXPECT_NEAR(summary_.pose->sem_to_afm.y0, shift.y0, 0.5 * pitch);
  EXPECT_GT(summary_.pose->places.front().probability, 0.99);
  EXPECT_TRUE(summary_.pose->verified());
}

TEST_F(JudgePlaces, APlaceWithoutRivalsStays) {
  hesitate(elsewhere, shift);
  summary_.pose->registration->rivals.clear();
  judge_places(job_, summary_, job_.sem->image, afm_, {});
  EXPECT_EQ(summary_.pose->sem_to_afm, elsewhere);
  EXPECT_FALSE(summary_.pose->verified());
}

TEST_F(JudgePlaces, MoreRivalsThanAreJudgedLeaveThePlaceOpen) {
  hesitate(elsewhere, shift);
  std::vector<RegistrationRival>& rivals = summary_.pose->registration->rivals;
  rivals.resize(4, rivals.front());
  judge_places(job_, summary_, job_.sem->image, afm_, {});
  EXPECT_FALSE(summary_.pose->every_rival_judged);
  EXPECT_FALSE(summary_.pose->verified());
}

/// An SEM image of nothing but noise agrees with any place.
TEST_F(JudgePlaces, TwoSurfacesThatBothExplainTheImagesAreBothGiven) {
  PlacedImage& image = job_.sem->image;
  image.values = Grid<double>(50, 40, 100.0);
  const Grid<double> noise = simulate_noise({0, 400}, 50, 40, 9);
  for (std::size_t i = 0; i < noise.size(); ++i) image.values.data()[i] += noise.data()[i];
  job_.calibration = GivenCalibration{{0.01, 0.01}, 100};
  job_.sem_noise = SemNoise{0, 400, 1e-3};
  job_.options.refine_transform = false;
  hesitate(shift, elsewhere);
  judge_places(job_, summary_, image, afm_, {});
  ASSERT_EQ(summary_.pose->places.size(), 2u);
  EXPECT_FALSE(summary_.pose->verified());

  const SemData sem{image, summary_.model->model, {0.01, 0.01},
                    100,   *job_.sem_noise,       summary_.pose->sem_to_afm};
  summary_.result = reconstruct(&afm_, &sem, job_.options);
  const auto rival = rival_surface(job_, summary_, afm_, sem, {});
  ASSERT_TRUE(rival.has_value());
  EXPECT_GT(rival->share_apart, 0.3);
  EXPECT_GT(rival->probability, 0.05);

  summary_.rival = rival;
  std::filesystem::create_directories(job_.folder);
  write_reconstruction(job_, summary_, &afm_, &sem, {});
  const io::TransformFile map = io::read_transform(job_.folder / "rival_transform.json");
  EXPECT_EQ(map.sem_to_afm, rival->found.sem_to_afm);
  EXPECT_FALSE(map.verified);
  EXPECT_NE(io::read_file(job_.folder / "rival.vti"), io::read_file(job_.folder / "surface.vti"));
  EXPECT_EQ(report("result")["registration"]["judged_by_both_images"].size(), 2u);
  EXPECT_GT(report("result")["registration"]["rival_surface"]["share_of_heights_apart"], 0.3);

  summary_.pose->places[1].sem_to_afm = summary_.pose->places[0].sem_to_afm;
  EXPECT_FALSE(rival_surface(job_, summary_, afm_, sem, {}).has_value());  // the same surface
}

}  // namespace
}  // namespace surf::workflow
