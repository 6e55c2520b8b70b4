// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "surf/core/error.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;

Box box(double x0, double y0, double z0, double x1, double y1, double z1) {
  Box b;
  b.extend(Vec3{x0, y0, z0});
  b.extend(Vec3{x1, y1, z1});
  return b;
}

const Box specimen = box(-100, 0, 0, 300, 200, 50);  // 400 x 200 nm about (100, 100, 25)

mc::ScanRequest size(int width, int height) {
  mc::ScanRequest r;
  r.width = width;
  r.height = height;
  return r;
}

mc::ScanRequest pixel(double x_nm, double y_nm) {
  mc::ScanRequest r;
  r.pixel_x_nm = x_nm;
  r.pixel_y_nm = y_nm;
  return r;
}

mc::ScanRequest region(double x0, double y0, double x1, double y1) {
  mc::ScanRequest r;
  r.region = mc::ScanRequest::Region{x0, y0, x1, y1};
  return r;
}

void expect_scan(const mc::Scan& s, int width, int height, double pixel_x, double pixel_y,
                 double center_x, double center_y) {
  EXPECT_EQ(s.width, width);
  EXPECT_EQ(s.height, height);
  EXPECT_NEAR(s.pixel_x_nm, pixel_x, 1e-12 * pixel_x);
  EXPECT_NEAR(s.pixel_y_nm, pixel_y, 1e-12 * pixel_y);
  EXPECT_NEAR(s.center_x_nm, center_x, 1e-9);
  EXPECT_NEAR(s.center_y_nm, center_y, 1e-9);
}

std::string usage_error(const mc::ScanRequest& request, const Box& extent = specimen) {
  try {
    resolve_scan(request, extent, {});
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ResolveScan, WithNothingGivenTakes256SquarePixelsAcrossTheLongerSide) {
  expect_scan(resolve_scan({}, specimen, {}), 256, 128, 400.0 / 256, 400.0 / 256, 100, 100);
  EXPECT_EQ(resolve_scan({}, specimen, {}).center_z_nm, 25);
}

TEST(ResolveScan, WithSizeAloneShowsAllOfTheSpecimenInSquarePixels) {
  expect_scan(resolve_scan(size(100, 100), specimen, {}), 100, 100, 4, 4, 100, 100);
  expect_scan(resolve_scan(size(400, 50), specimen, {}), 400, 50, 4, 4, 100, 100);
}

TEST(ResolveScan, WithPixelsAloneCoversTheSpecimen) {
  expect_scan(resolve_scan(pixel(2, 2), specimen, {}), 200, 100, 2, 2, 100, 100);
  expect_scan(resolve_scan(pixel(3, 7), specimen, {}), 134, 29, 3, 7, 100, 100);
}

TEST(ResolveScan, WithRegionAloneTakes256NearlySquarePixels) {
  expect_scan(resolve_scan(region(-96, -48, 96, 48), specimen, {}), 256, 128, 0.75, 0.75, 0, 0);
  expect_scan(resolve_scan(region(0, 0, 256, 10.4), specimen, {}), 256, 10, 1, 1.04, 128, 5.2);
}

TEST(ResolveScan, TakesAnyTwo) {
  auto r = region(-96, -96, 96, 0);
  r.width = 64;
  r.height = 48;
  expect_scan(resolve_scan(r, specimen, {}), 64, 48, 3, 2, 0, -48);

  r = region(-96, -96, 96, 0);
  r.pixel_x_nm = 2;
  r.pixel_y_nm = 3;
  expect_scan(resolve_scan(r, specimen, {}), 96, 32, 2, 3, 0, -48);

  r = size(10, 20);
  r.pixel_x_nm = r.pixel_y_nm = 5;
  expect_scan(resolve_scan(r, specimen, {}), 10, 20, 5, 5, 100, 100);
}

TEST(ResolveScan, RefusesThree) {
  auto r = region(0, 0, 10, 10);
  r.width = r.height = 10;
  r.pixel_x_nm = r.pixel_y_nm = 1;
  EXPECT_THAT(usage_error(r), HasSubstr("all three"));
}

TEST(ResolveScan, AllowsPixelsThatFitTheRegionToAMillionth) {
  auto r = region(0, 0, 100, 100);
  r.pixel_x_nm = r.pixel_y_nm = 0.1 * (1 + 5e-7);
  EXPECT_EQ(resolve_scan(r, specimen, {}).width, 1000);
  r.pixel_x_nm = 0.1 * (1 + 5e-6);
  EXPECT_THAT(usage_error(r), HasSubstr("not a whole number"));
}

TEST(ResolveScan, NamesPixelSizesThatWouldFit) {
  auto r = region(0, 0, 100, 100);
  r.pixel_x_nm = r.pixel_y_nm = 30;
  EXPECT_THAT(usage_error(r), HasSubstr("33.3333333 nm (3 pixels) or 25 nm (4 pixels)"));
}

TEST(ResolveScan, RefusesNonsense) {
  EXPECT_THAT(usage_error(size(0, 5)), HasSubstr("scan.size"));
  EXPECT_THAT(usage_error(pixel(-1, 1)), HasSubstr("scan.pixel_size"));
  EXPECT_THAT(usage_error(pixel(0, 1)), HasSubstr("scan.pixel_size"));
  EXPECT_THAT(usage_error(pixel(NAN, 1)), HasSubstr("scan.pixel_size"));
  EXPECT_THAT(usage_error(region(5, 0, 5, 1)), HasSubstr("scan.region"));
  EXPECT_THAT(usage_error(region(0, 0, HUGE_VAL, 1)), HasSubstr("scan.region"));
  EXPECT_THAT(usage_error({}, Box{}), HasSubstr("scan.region"));
}

TEST(ResolveScan, RefusesImagesThatAreTooLarge) {
  EXPECT_THAT(usage_error(size(1000000, 1000000)), HasSubstr("too large"));
  EXPECT_THAT(usage_error(pixel(1e-6, 1e-6)), HasSubstr("too large"));
  EXPECT_THAT(usage_error(pixel(1e-300, 1e-300)), HasSubstr("too large"));
}

TEST(ResolveScan, ShowsAllThatATiltedBeamSees) {
  mc::Beam beam;
  beam.tilt_deg = 30;
  const Box cube = box(-50, -50, 0, 50, 50, 100);
  const double seen_nm = 100 * std::cos(30 * 0.017453292519943295) + 100 * 0.5;
  const mc::Scan s = resolve_scan(pixel(1, 1), cube, beam);
  EXPECT_EQ(s.width, std::ceil(seen_nm));
  EXPECT_EQ(s.height, 100);
  EXPECT_EQ(s.center_z_nm, 50);

  beam.azimuth_deg = 90;
  const mc::Scan turned = resolve_scan(pixel(1, 1), cube, beam);
  EXPECT_EQ(turned.width, 100);
  EXPECT_EQ(turned.height, s.width);
}

}  // namespace
}  // namespace surf::workflow
