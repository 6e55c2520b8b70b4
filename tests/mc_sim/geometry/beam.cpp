// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/beam.h"

#include <gmock/gmock.h>

#include <limits>

#include "surf/core/error.h"
#include "surf/mc/geometry/largest_length.h"

namespace surf::mc {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double too_long[] = {1.001 * largest_length_nm, 1e19, 1e300, infinity, not_a_number};

Beam beam_of(double Beam::*field, double value) {
  Beam beam;
  beam.*field = value;
  return beam;
}

Scan scan_of(double Scan::*field, double value) {
  Scan scan;
  scan.*field = value;
  return scan;
}

TEST(Beam, LengthsHaveALimit) {
  struct Case {
    double Beam::*field;
    const char* option;
    bool may_be_negative;
  };
  for (const Case& c :
       {Case{&Beam::spot_nm, "beam.spot", false}, Case{&Beam::focus_nm, "beam.focus", true},
        Case{&Beam::working_distance_nm, "beam.working_distance", false}}) {
    for (const double value : too_long) {
      EXPECT_THAT([&] { validate(beam_of(c.field, value)); },
                  ThrowsMessage<UsageError>(HasSubstr(c.option)))
          << value;
      EXPECT_THROW(validate(beam_of(c.field, -value)), UsageError) << c.option;
    }
    EXPECT_NO_THROW(validate(beam_of(c.field, largest_length_nm)));
    if (c.may_be_negative) EXPECT_NO_THROW(validate(beam_of(c.field, -largest_length_nm)));
    else EXPECT_THROW(validate(beam_of(c.field, -1)), UsageError);
  }
}

TEST(Beam, AzimuthsAreWithinTenTurns) {
  for (const double azimuth : {-3600.0, 270.0, 3600.0})
    EXPECT_NO_THROW(validate(beam_of(&Beam::azimuth_deg, azimuth)));
  for (const double azimuth : {-3601.0, 1e300, infinity, not_a_number})
    EXPECT_THAT([&] { validate(beam_of(&Beam::azimuth_deg, azimuth)); },
                ThrowsMessage<UsageError>(HasSubstr("beam.azimuth")))
        << azimuth;
}

TEST(Scan, LengthsHaveALimit) {
  for (const double value : too_long) {
    for (double Scan::*center : {&Scan::center_x_nm, &Scan::center_y_nm, &Scan::center_z_nm}) {
      EXPECT_THAT([&] { validate(scan_of(center, value)); },
                  ThrowsMessage<UsageError>(HasSubstr("scan.region")))
          << value;
      EXPECT_THROW(validate(scan_of(center, -value)), UsageError) << value;
    }
    for (double Scan::*pixel : {&Scan::pixel_x_nm, &Scan::pixel_y_nm})
      EXPECT_THAT([&] { validate(scan_of(pixel, value)); },
                  ThrowsMessage<UsageError>(HasSubstr("scan.pixel_size")))
          << value;
  }
  EXPECT_NO_THROW(validate(scan_of(&Scan::center_x_nm, -largest_length_nm)));
  EXPECT_NO_THROW(validate(scan_of(&Scan::pixel_x_nm, 4 * largest_length_nm / 256)));
}

}  // namespace
}  // namespace surf::mc
