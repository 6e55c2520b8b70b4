// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/slope_table.h"

#include "specimens.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

const mc::Material& silicon() { return io::find_material("Si", "test"); }

SlopeTableOptions quick(SlopeSpecimen specimen, std::int64_t electrons = 4000) {
  SlopeTableOptions options;
  options.specimen = specimen;
  options.electrons = electrons;
  return options;
}

/// Both tables once for all tests: one library serves them.
const std::pair<SlopeTable, SlopeTable>& tables() {
  static const auto made = [] {
    mc::FreshLibraries libraries;
    return std::pair{
        make_slope_table(silicon(), 1000, quick(SlopeSpecimen::single_plane), &libraries),
        make_slope_table(silicon(), 1000, quick(SlopeSpecimen::two_planes), &libraries)};
  }();
  return made;
}

double z_of(const mc::Estimate& a, const mc::Estimate& b) {
  return (a.mean - b.mean) / std::hypot(a.standard_error, b.standard_error);
}

TEST(SlopeTable, RisesWithTheSlope) {
  for (const SlopeTable* table : {&tables().first, &tables().second}) {
    ASSERT_EQ(table->se.size(), 18u);
    ASSERT_EQ(table->bse.size(), 18u);
    for (std::size_t i = 1; i <= 15; ++i) {  // to 75 degrees
      EXPECT_GT(z_of(table->se[i], table->se[i - 1]), -3) << 5 * i << " degrees";
    }
    for (std::size_t i = 6; i <= 15; i += 3)
      EXPECT_GT(z_of(table->se[i], table->se[i - 3]), 2) << 5 * i << " degrees";
    EXPECT_GT(table->se[15].mean, 2 * table->se[0].mean);
    EXPECT_GT(table->bse[15].mean, 1.5 * table->bse[0].mean);
  }
}

TEST(SlopeTable, OfOnePlaneIsATiltedBeam) {
  for (const int i : {0, 6, 12, 16}) {
    const test::Yields direct = test::flat_yields("Si", 1000, 5.0 * i, 6000);
    EXPECT_LT(std::fabs(z_of(tables().first.se[static_cast<std::size_t>(i)], direct.se)),
              test::z_limit(8));
    EXPECT_LT(std::fabs(z_of(tables().first.bse[static_cast<std::size_t>(i)], direct.bse)),
              test::z_limit(8));
  }
}

TEST(SlopeTable, TheGroundAddsSecondariesAtSteepSlopes) {
  mc::Estimate one, two;  // added up over angles, with squares of errors
  for (const std::size_t i : {9u, 10u, 11u, 12u, 13u, 14u}) {
    one.mean += tables().first.se[i].mean, two.mean += tables().second.se[i].mean;
    one.standard_error = std::hypot(one.standard_error, tables().first.se[i].standard_error);
    two.standard_error = std::hypot(two.standard_error, tables().second.se[i].standard_error);
  }
  EXPECT_GT(z_of(two, one), 4);
  EXPECT_EQ(tables().second.se[0].mean, tables().first.se[0].mean);
  for (const std::size_t i : {12u, 14u, 16u})
    EXPECT_LT(z_of(tables().second.bse[i], tables().first.bse[i]), -5)
        << "the ground catches what goes down";
}

/// The shape that the replay and the ground are seen on, simulated directly at another place along
/// the slope.
TEST(SlopeTable, DoesNotDependOnWhereTheBeamLands) {
  mc::Specimen specimen;
  specimen.materials = {silicon()};
  HeightField slope;  // 60 degrees, 200 nm wide: ranges are far less
  slope.z_nm = Grid<double>(40, 2);
  slope.pitch_x_nm = 200, slope.pitch_y_nm = 4000;
  slope.origin_x_nm = -30 * 200.0, slope.origin_y_nm = -2000;
  for (int y = 0; y < 2; ++y)
    for (int x = 31; x < 40; ++x) slope.z_nm(x, y) = 200 * std::sqrt(3.0);
  specimen.height_field = mc::HeightFieldBody{"slope", slope, 0, Edge::flat};
  for (const double x : {80.0, 140.0}) {
    mc::Scan scan = test::square_scan(1, 1);
    scan.center_x_nm = x;
    const auto direct = test::yields(test::simulate(specimen, {}, scan, 6000, {}, 7));
    EXPECT_LT(std::fabs(z_of(tables().second.se[12], direct.se)), test::z_limit(4)) << x;
    EXPECT_LT(std::fabs(z_of(tables().second.bse[12], direct.bse)), test::z_limit(4)) << x;
  }
}

TEST(SlopeTable, IsTheSameWithAnyThreads) {
  SlopeTableOptions options = quick(SlopeSpecimen::two_planes, 300);
  options.step_deg = 40, options.threads = 1;
  const SlopeTable one = make_slope_table(silicon(), 800, options);
  options.threads = 3;
  const SlopeTable three = make_slope_table(silicon(), 800, options);
  ASSERT_EQ(one.se.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(one.se[i].mean, three.se[i].mean);
    EXPECT_EQ(one.bse[i].standard_error, three.bse[i].standard_error);
  }
}

TEST(SlopeTable, BecomesASlopeModel) {
  const SlopeModelParameters p = to_slope_model(tables().second);
  EXPECT_EQ(p.form, SlopeForm::table);
  EXPECT_EQ(p.table_step_deg, 5);
  ASSERT_EQ(p.channels.size(), 2u);
  EXPECT_EQ(p.channels[0].name, "SE");
  EXPECT_EQ(p.channels[1].yields.at(17), tables().second.bse[17].mean);
}

TEST(SlopeTable, CanBeInterruptedAndRefusesNonsense) {
  CancelToken token;
  token.cancel();
  SlopeTableOptions options = quick(SlopeSpecimen::single_plane);
  options.watch.cancel = &token;
  EXPECT_THROW(make_slope_table(silicon(), 1000, options), Interrupted);
  options = {};
  options.last_deg = 90;
  EXPECT_THROW(make_slope_table(silicon(), 1000, options), UsageError);
  options = {};
  options.electrons = 1;
  EXPECT_THROW(make_slope_table(silicon(), 1000, options), UsageError);
}

}  // namespace
}  // namespace surf::workflow
