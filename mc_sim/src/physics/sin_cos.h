// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace surf::mc {

/// sin and cos of 2 pi `turn` for 0 <= turn < 4, to 2e-10.
inline void sin_cos_turn(double turn, double& sine, double& cosine) {
  const double quarters = 4.0 * turn;
  const int nearest = static_cast<int>(quarters + 0.5);
  const double r = quarters - nearest;  // quarter turns in [-1/2, 1/2]
  const double r2 = r * r;
  const double s = r * (1.5707963267948966 +
                        r2 * (-0.6459640975062462 +
                              r2 * (0.07969262624616703 +
                                    r2 * (-0.004681754135318687 + r2 * 1.6044118478735975e-4))));
  const double c =
      1.0 + r2 * (-1.2337005501361697 +
                  r2 * (0.25366950790104802 +
                        r2 * (-0.020863480763352960 +
                              r2 * (9.1926027483942659e-4 - r2 * 2.5202042373060605e-5))));
  const double a = (nearest & 1) ? c : s;
  const double b = (nearest & 1) ? s : c;
  sine = (nearest & 2) ? -a : a;
  cosine = ((nearest + 1) & 2) ? -b : b;
}

}  // namespace surf::mc
