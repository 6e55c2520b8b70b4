// SPDX-License-Identifier: GPL-3.0-or-later
// What Gwyddion 2.62 (libgwyprocess) gives for a real scan, ../shared/data/afm/Park_034.gwy, where
// its definitions are ours. Where they differ:
// - its dilation and erosion take the physical tip, apex up, the structuring function turned by 180
//   degrees; what its blind reconstruction gives is the structuring function itself;
// - its heights are quantised to a 10,000th of their range for blind tips;
// - beyond the border its morphology repeats the edge, ours takes what is known: compared inside
// only;
// - its median filter is compared in bench_level alone (docs/explanation/levelling.md).
#include <cmath>

#include "../io_test.h"
#include "surf/afm/background.h"
#include "surf/afm/blind_tip.h"
#include "surf/afm/morphology.h"
#include "surf/afm/roughness.h"
#include "surf/io/height_field_file.h"

namespace surf::io {
namespace {

class GwyddionNumbers : public test::RealFiles {
 protected:
  void SetUp() override {
    RealFiles::SetUp();
    if (IsSkipped()) return;
    scan_ = read_height_field(root_ / "afm" / "Park_034.gwy").field;
    scan_.pitch_x_nm = scan_.pitch_y_nm = 1;  // as there: one unit per pixel
  }

  // By column and row from the top, as there.
  double at(const HeightField& f, int column, int row) const {
    return f.z_nm(column, f.z_nm.height() - 1 - row);
  }

  HeightField scan_;
};

struct Probe {
  int column, row;
  double z_nm;
};

// Rows from the top, apex up: x right, y down; not symmetric.
Tip lopsided() {
  Tip physical;
  physical.z_nm = Grid<double>(9, 9);
  physical.apex_x = physical.apex_y = 4;
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column) {
      const double x = column - 4, y = row - 4;
      physical.z_nm(column, 8 - row) =
          -(x * x + 0.5 * y * y + 0.25 * x * y) * 0.1 - 0.05 * std::max(0.0, x);
    }
  return physical;
}

TEST_F(GwyddionNumbers, RoughnessOfTheScan) {
  HeightField f = scan_;
  subtract(f, fit_plane(f));
  const Roughness r = measure_roughness(f);
  EXPECT_NEAR(r.sa_nm, 0.378810886, 1e-7);
  EXPECT_NEAR(r.sq_nm, 0.635113014, 1e-7);
}

TEST_F(GwyddionNumbers, DilationAndErosion) {
  const HeightField dilated = dilate(scan_, reflected(lopsided()));
  for (const Probe& p : {Probe{30, 40, 0.340509653},
                         {100, 65, 4.48717594},
                         {128, 128, 0.244122708},
                         {200, 31, 0.463562047},
                         {77, 213, 0.0763024449}})
    EXPECT_NEAR(at(dilated, p.column, p.row), p.z_nm, 1e-6) << p.column << " " << p.row;
  const HeightField eroded = erode(scan_, reflected(lopsided()));
  for (const Probe& p : {Probe{30, 40, -0.738089323},
                         {100, 65, -2.33930426},
                         {128, 128, -1.71547174},
                         {200, 31, -1.38664594},
                         {77, 213, -1.71035519}})
    EXPECT_NEAR(at(eroded, p.column, p.row), p.z_nm, 1e-6) << p.column << " " << p.row;
}

// gwy_tip_estimate_partial, then _full, threshold 0.3 nm, no border.
TEST_F(GwyddionNumbers, BlindTip) {
  constexpr double theirs[9][9] = {
      // rows from the top
      {-9.67466, -8.82569, -8.38686, -8.47893, -8.63557, -8.78623, -9.63639, -10.43873, -10.65037},
      {-9.17006, -7.89541, -7.05003, -6.72240, -7.35374, -7.78540, -9.17604, -10.22350, -10.57624},
      {-8.72764, -7.31548, -5.64504, -4.97663, -5.09023, -6.20704, -7.65507, -9.04570, -9.73444},
      {-8.53752, -7.06318, -5.13566, -2.89486, -2.77649, -4.51747, -6.25367, -7.64431, -8.78145},
      {-8.44066, -6.96633, -5.03881, -2.38548, 0.00000, -2.62822, -5.00055, -7.00698, -7.96237},
      {-8.14412, -6.77142, -4.74227, -2.82312, -1.92991, -3.43055, -5.74549, -7.12656, -8.12140},
      {-7.74953, -6.47488, -4.83673, -3.91243, -3.60513, -4.43736, -6.24411, -7.40277, -8.26130},
      {-7.52234, -6.69131, -6.07192, -5.25763, -5.27317, -5.82082, -6.70088, -7.54028, -8.51719},
      {-8.15967, -7.41592, -6.95437, -6.72718, -6.60402, -7.12297, -7.98150, -8.50165, -8.63557}};
  constexpr double quantum_nm = 12.0 / 10000;  // of the scan's range
  BlindTipOptions options;
  options.width = options.height = 9;
  options.threshold_nm = 0.3;
  options.border = false;
  const auto [tip, summary] = blind_tip({scan_}, options);
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column)
      EXPECT_NEAR(tip.z_nm(column, 8 - row), theirs[row][column], 3 * quantum_nm)
          << column << " " << row;
}

}  // namespace
}  // namespace surf::io
