// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/tables/cascade_tables.h"

#include <numeric>

#include "cascades/cascade_reader.h"
#include "cascades/walk_cascade.h"
#include "replay/replay_test.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf::mc {
namespace {

/// One page of silicon at 1 keV, for all tests.
const CascadeLibrary& silicon() {
  static const CascadeLibrary library = [] {
    const Material& material = io::find_material("Si", "test");
    CascadeLibrary made({material, {}, 1000 + make_medium(material, {}).barrier_ev(), 5});
    made.grow(1, 0);
    return made;
  }();
  return library;
}

struct Ends {
  double primaries = 0, primaries_above = 0, others = 0, others_above = 0;
  std::vector<CascadeSegment> segments;
  bool keep = false;
  void segment(const CascadeSegment& s) {
    if (keep) segments.push_back(s);
  }
  void stop(const Vec3& at, bool primary) {
    (primary ? primaries : others) += 1;
    (primary ? primaries_above : others_above) += at.z > 0;
  }
};

Ends all_ends() {
  Ends ends;
  const EnergyCode code(silicon().medium().cutoff_ev(), silicon().settings().start_energy_ev);
  CascadeWalk<Ends> walk(code, ends);
  for (std::size_t i = 0; i < silicon().cascades(); ++i) walk.walk(silicon().cascade(i).data());
  return ends;
}

TEST(WalkCascade, TellsWhatTheFormatSays) {
  const double cutoff = silicon().medium().cutoff_ev(), top = silicon().settings().start_energy_ev;
  const EnergyCode code(cutoff, top);
  for (const std::size_t i : {0u, 7u, 1000u}) {
    Ends told;
    told.keep = true;
    CascadeWalk<Ends>(code, told).walk(silicon().cascade(i).data());
    test::CascadeReader read(silicon().cascade(i), cutoff, top, silicon().medium().barrier_ev());
    EXPECT_EQ(told.primaries, 1);
    EXPECT_EQ(told.others + 1, static_cast<double>(read.electrons.size()));
    std::size_t segments = 0;
    for (const auto& e : read.electrons) segments += e.points_nm.size() - 1;
    ASSERT_EQ(told.segments.size(), segments);
    EXPECT_EQ(told.segments[0].from, Vec3{});
    EXPECT_TRUE(told.segments[0].primary && told.segments[0].first);
    EXPECT_LT(length(told.segments[0].to - read.electrons[0].points_nm[1]), 1e-9);
    EXPECT_NEAR(told.segments[0].energy_to_ev, read.energy_ev(read.electrons[0].energies[1]), 1e-9);
  }
}

TEST(StoppingPoints, HoldEveryElectronOnce) {
  const StoppingPointParameters table = stopping_points(silicon());
  const Ends ends = all_ends();
  const double n = static_cast<double>(silicon().cascades());
  ASSERT_EQ(table.channels.size(), 2u);
  const auto total = [&](std::size_t c) {
    const auto& d = table.channels[c].density_per_nm;
    return std::accumulate(d.begin(), d.end(), 0.0) * table.height_step_nm;
  };
  EXPECT_NEAR(total(0), ends.others / n, 1e-9 * ends.others / n);
  EXPECT_NEAR(total(1), 1, 1e-9);
}

TEST(StoppingPoints, GiveTheLibrarysOwnValueOnFlatGround) {
  const Ends ends = all_ends();
  const double n = static_cast<double>(silicon().cascades()), above = ends.primaries_above / n;
  for (const double pitch : {1.0, 3.0}) {
    const auto model = make_stopping_point({.pixel_nm = pitch}, stopping_points(silicon()));
    const ModelImages images = model->predict({{pitch, pitch}, Grid<double>(4, 3)});
    EXPECT_NEAR(images[0](1, 1), ends.others_above / n, 0.03 * ends.others_above / n);
    EXPECT_NEAR(images[1](1, 1), above / (1 - above), 0.03 * above / (1 - above));
  }
  // Aristov's relation holds for silicon to a tenth or two.
  const double measured = test::flat_yields("Si", 1000, 0, 20000).bse.mean;
  EXPECT_NEAR(above / (1 - above), measured, 0.35 * measured);
}

TEST(StoppingPoints, AreScaledToAKnownYield) {
  const auto model =
      make_stopping_point({.pixel_nm = 3}, stopping_points(silicon(), {.flat_se_yield = 0.9}));
  EXPECT_NEAR(model->predict({{3, 3}, Grid<double>(4, 3, 7)})[0](1, 1), 0.9, 1e-9);
  const auto plain = make_stopping_point({.pixel_nm = 3}, stopping_points(silicon()));
  EXPECT_EQ(model->predict({{3, 3}, Grid<double>(4, 3)})[1],
            plain->predict({{3, 3}, Grid<double>(4, 3)})[1]);
}

TEST(StoppingPoints, RefuseNothingAndNonsense) {
  const CascadeLibrary empty(silicon().settings());
  EXPECT_THROW(stopping_points(empty), InvalidInput);
  EXPECT_THROW(stopping_points(silicon(), {.rings = 0}), UsageError);
  EXPECT_THROW(stopping_points(silicon(), {.heights = 1}), UsageError);
  EXPECT_THROW(stopping_points(silicon(), {.flat_se_yield = -1}), UsageError);
}

}  // namespace
}  // namespace surf::mc
