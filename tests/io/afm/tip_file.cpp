// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/tip_file.h"

#include <limits>

#include "../io_test.h"
#include "surf/io/height_field_file.h"

namespace surf::io {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();

/// Leans to the right; one corner is missing.
Tip some_tip() {
  Tip tip;
  tip.pitch_x_nm = 2;
  tip.pitch_y_nm = 3;
  tip.z_nm = Grid<double>(4, 3);
  tip.z_nm.data() = {-8, -4, -5, nothing, -6, 0, -1, -7, -9, -2, -3, -8};
  tip.apex_x = 1;
  tip.apex_y = 1;
  return tip;
}

void expect_same(const Tip& tip, const Tip& expected) {
  EXPECT_EQ(tip.pitch_x_nm, expected.pitch_x_nm);
  EXPECT_EQ(tip.pitch_y_nm, expected.pitch_y_nm);
  EXPECT_EQ(tip.apex_x, expected.apex_x);
  EXPECT_EQ(tip.apex_y, expected.apex_y);
  ASSERT_EQ(tip.z_nm.width(), expected.z_nm.width());
  ASSERT_EQ(tip.z_nm.height(), expected.z_nm.height());
  for (std::size_t i = 0; i < tip.z_nm.size(); ++i) {
    if (expected.z_nm.data()[i] == nothing) EXPECT_EQ(tip.z_nm.data()[i], nothing);
    else EXPECT_NEAR(tip.z_nm.data()[i], expected.z_nm.data()[i], 1e-6) << i;
  }
}

TEST(TipFile, ComesBackFromEveryFormat) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.gsf", "a.tif", "a.txt"}) {
    SCOPED_TRACE(name);
    write_tip(folder.path() / name, some_tip(), {{"made", "by hand"}});
    expect_same(read_tip(folder.path() / name), some_tip());
    EXPECT_EQ(read_height_field(folder.path() / name).metadata.at("tip"), "structuring function");
  }
}

TEST(TipFile, ADoubtStaysWithTheTip) {
  const test::TemporaryFolder folder;
  Tip tip = some_tip();
  for (const char* name : {"a.gsf", "a.tif", "a.txt"}) {
    write_tip(folder.path() / name, tip);
    EXPECT_EQ(read_tip(folder.path() / name).doubt, "") << name;
  }
  tip.doubt = "its end is flat; and more";
  for (const char* name : {"a.gsf", "a.tif", "a.txt"}) {
    write_tip(folder.path() / name, tip);
    EXPECT_EQ(read_tip(folder.path() / name).doubt, tip.doubt) << name;
  }
}

HeightField field_of(const Tip& tip, double sign, double shift) {
  HeightField field;
  field.pitch() = tip.pitch();
  field.z_nm = tip.z_nm;
  field.valid = Mask(tip.z_nm.width(), tip.z_nm.height(), 1);
  for (std::size_t i = 0; i < field.z_nm.size(); ++i) {
    double& z = field.z_nm.data()[i];
    if (z == nothing) field.valid.data()[i] = 0;
    z = z == nothing ? 0 : sign * z + shift;
  }
  return field;
}

TEST(TipFile, PhysicalTipsAreTurnedWhereverTheyPoint) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "physical.txt";
  for (const double sign : {1.0, -1.0}) {  // apex up, apex down
    write_height_field(file, field_of(some_tip(), sign, 100), {{"tip", "physical"}});
    expect_same(read_tip(file), reflected(some_tip()));
  }
  write_height_field(file, field_of(some_tip(), 1, 100));
  expect_same(read_tip(file), some_tip());
}

TEST(TipFile, TheSmallestTipIsKept) {
  const test::TemporaryFolder folder;
  Tip point;
  point.z_nm = Grid<double>(1, 1);
  write_tip(folder.path() / "a.gsf", point);
  const Tip read = read_tip(folder.path() / "a.gsf");
  EXPECT_EQ(read.z_nm(read.apex_x, read.apex_y), 0);
  EXPECT_EQ(read.z_nm.data(), (std::vector<double>{0, nothing, nothing, nothing}));
}

TEST(TipFile, AnApexMustBeOne) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "two.txt";
  test::write(file, "0 -1 0\n-1 -2 -1\n");
  EXPECT_THAT(test::complaint<InvalidInput>([&] { read_tip(file); }),
              testing::HasSubstr("2 places"));
  test::write(file, "-1 -1 -1 -1\n-1 0 0 0\n-1 -1 -1 -1\n");  // flat, but one
  const Tip tip = read_tip(file);
  EXPECT_EQ(tip.apex_x, 2);
  EXPECT_EQ(tip.apex_y, 1);
}

TEST(TipFile, AFlatTipKeepsTheApexItWasGiven) {
  const test::TemporaryFolder folder;
  Tip tip = some_tip();
  tip.z_nm(3, 2) = 0;  // does not touch the apex
  write_tip(folder.path() / "a.gsf", tip);
  expect_same(read_tip(folder.path() / "a.gsf"), tip);
}

}  // namespace
}  // namespace surf::io
