// SPDX-License-Identifier: GPL-3.0-or-later
#include "search_places.h"

#include <cmath>

#include "hilly_pair.h"

namespace surf::workflow {
namespace {

class SearchPlaces : public HillyPair {
 protected:
  SearchPlaces() {
    afm_ = prepare_afm(job_.afm->scan, job_.afm->preparation);
    model_ = model();
    pose_.sem_to_afm = {1, 0, 110, 0, 1, 20};
    pose_.registration.emplace();
    pose_.registration->verdict = RegistrationVerdict::ambiguous;
    pose_.registration->rivals = {{shift, 0.9, 12}};
  }
  bool go(const PoseOptions& options) {
    return go_to_likeliest_place(pose_, options, afm_, job_.sem->image, model_, 1, {});
  }

  PreparedAfm afm_;
  StoredModel model_;
  Pose pose_;
};

TEST_F(SearchPlaces, GoesWhereTheScanExplainsTheImageUnderSomeTip) {
  EXPECT_TRUE(go({}));
  EXPECT_NEAR(pose_.sem_to_afm.x0, shift.x0, 2 * pitch);
  EXPECT_NEAR(pose_.sem_to_afm.y0, shift.y0, 2 * pitch);
  EXPECT_EQ(pose_.registration->verdict, RegistrationVerdict::ambiguous);
}

TEST_F(SearchPlaces, LeavesPlacesThatAreVerifiedOrWereGiven) {
  const Affine before = pose_.sem_to_afm;
  PoseOptions given;
  given.registration.start = before;
  EXPECT_FALSE(go(given));
  pose_.registration->verdict = RegistrationVerdict::verified;
  EXPECT_FALSE(go({}));
  EXPECT_EQ(pose_.sem_to_afm, before);
}

}  // namespace
}  // namespace surf::workflow
