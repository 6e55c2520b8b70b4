// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/sampling/choose_method.h"

#include <gmock/gmock.h>

#include "cascades/cascade_sample.h"
#include "specimens.h"
#include "surf/core/error.h"

namespace surf::mc {
namespace {

using testing::HasSubstr;

// Without secondaries cascades are short, and so are these tests.
Physics short_cascades() {
  Physics physics;
  physics.secondaries = false;
  return physics;
}

Scene scene_of(int pixels, const Physics& physics = short_cascades(), double energy_ev = 500) {
  Beam beam;
  beam.energy_ev = energy_ev;
  return Scene(test::flat("Si"), beam, test::square_scan(100, pixels), physics);
}

TEST(ChooseMethod, FewPrimariesAreFollowedDirectly) {
  const MethodChoice choice = choose_method(scene_of(4), {});
  EXPECT_EQ(choice.method, Method::direct);
  EXPECT_THAT(choice.reason, HasSubstr("3.2 thousand primaries are too few for 10.2 thousand"));
}

TEST(ChooseMethod, ManyPrimariesShareCascades) {
  const MethodChoice choice = choose_method(scene_of(400), {});
  EXPECT_EQ(choice.method, Method::replay);
  EXPECT_THAT(choice.reason, HasSubstr("32 million primaries share 10.2 thousand cascades"));
  EXPECT_GT(choice.library_bytes, 0);
}

TEST(ChooseMethod, EveryMaterialNeedsALibrary) {
  Specimen one = test::flat("Si"), two = one;
  two.materials.push_back(io::find_material("Au", "test"));
  two.bodies.push_back({"pillar", test::pillar(20, 20), 1});
  const Scan scan = test::square_scan(100, 8);
  EXPECT_GT(choose_method(Scene(two, {}, scan, short_cascades()), {}).library_bytes,
            choose_method(Scene(one, {}, scan, short_cascades()), {}).library_bytes);
}

TEST(ChooseMethod, WhatReplayCannotServeIsDirect) {
  MethodLimits observed, narrow;
  observed.observed = true;
  narrow.library_bytes = 1e3;
  Physics no_loss = short_cascades();
  no_loss.loss = LossModel::none;
  const Scene usual = scene_of(400), lossless = scene_of(400, no_loss);
  const struct {
    const Scene& scene;
    MethodLimits limits;
    const char* reason;
  } cases[] = {{usual, observed, "whole track"},
               {lossless, {}, "continuous loss"},
               {usual, narrow, "memory, more than 1e-06"}};
  for (const auto& c : cases) {
    const MethodChoice choice = choose_method(c.scene, {}, {}, c.limits);
    EXPECT_EQ(choice.method, Method::direct) << c.reason;
    EXPECT_THAT(choice.reason, HasSubstr(c.reason));
    try {
      choose_method(c.scene, {}, Method::replay, c.limits);
      ADD_FAILURE() << c.reason << ": no error";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.reason));
    }
    SimulationOptions accurate;
    accurate.budget = Accuracy{0.1};
    if (c.limits.observed) EXPECT_THROW(choose_method(c.scene, accurate, {}, c.limits), UsageError);
    else
      EXPECT_EQ(choose_method(c.scene, accurate, {}, c.limits).method, Method::direct) << c.reason;
  }
}

TEST(ChooseMethod, WhatIsAskedForIsTaken) {
  const Scene scene = scene_of(4);
  EXPECT_EQ(choose_method(scene, {}, Method::replay).method, Method::replay);
  EXPECT_EQ(choose_method(scene_of(400), {}, Method::direct).method, Method::direct);
}

TEST(ChooseMethod, AnAccuracyTakesReplayWhereItsPrimariesAreMany) {
  SimulationOptions accurate;
  accurate.budget = Accuracy{0.1};
  const Scene few = scene_of(3), many = scene_of(100);
  const MethodChoice direct = choose_method(few, accurate), replay = choose_method(many, accurate);
  EXPECT_EQ(direct.method, Method::direct);
  EXPECT_THAT(direct.reason, HasSubstr("for this accuracy are too few for 10.2 thousand"));
  EXPECT_EQ(replay.method, Method::replay);
  EXPECT_THAT(replay.reason, HasSubstr("for this accuracy share 10.2 thousand"));
  // The number foretold is near the number spent.
  accurate.method = Method::direct;
  const SimulationResult spent = simulate(few, accurate);
  double told = 0;
  ASSERT_EQ(std::sscanf(direct.reason.c_str(), "about %lf", &told), 1);
  if (direct.reason.find("thousand") != std::string::npos) told *= 1e3;
  EXPECT_NEAR(told, static_cast<double>(spent.balance.incident), 0.6 * told);
  EXPECT_EQ(choose_method(many, accurate, Method::direct).method, Method::direct);
}

TEST(ChooseMethod, EstimatesTheSizeOfALibrary) {
  const CascadeSettings settings{io::find_material("Si", "test"), short_cascades(), 500, 1};
  CascadeLibrary library(settings);
  library.grow(2048, 0);
  EXPECT_NEAR(sample_cascades(settings).bytes * double(library.cascades()), double(library.bytes()),
              0.1 * double(library.bytes()));
}

TEST(ChooseMethod, NamesAreReadBack) {
  for (const Method m : {Method::direct, Method::replay}) EXPECT_EQ(parse_method(name(m), "x"), m);
  EXPECT_FALSE(parse_method("auto", "x"));
  EXPECT_THROW(parse_method("fast", "--method"), UsageError);
}

}  // namespace
}  // namespace surf::mc
