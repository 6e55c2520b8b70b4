// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace surf::workflow {

/// The measurements of the thesis (table 10-1): sums of squared height differences of the eroded
/// scan and of the reconstruction from scan and SEM image, and the time of the reconstruction on a
/// 1.3 GHz Pentium M. The thesis uses other surfaces and does not state the number of heights, so
/// that only the ratio can be compared.
struct ThesisPoint {
  const char* test;
  bool real;  ///< compared with the eroded scan of a sharper tip; false: with the true surface
  double afm_squares, both_squares;
  double hours;

  /// Ratio of root mean squares.
  double ratio() const { return std::sqrt(both_squares / afm_squares); }
};

inline constexpr const char* thesis_source =
    "Seeger 2004, table 10-1; 1.3 GHz Pentium M, other surfaces";

inline constexpr ThesisPoint thesis_points[] = {
    {"real data test 1", true, 15.7e6, 3.19e6, 3.5},
    {"real data test 2", true, 22.7e6, 39.5e6, 2},
    {"synthetic data test 1", false, 16.8e6, 1.92e6, 4},
    {"synthetic data test 2", false, 90.7e6, 36.0e6, 6},
    {"synthetic data test 3", false, 22.5e6, 9.32e6, 6},
    {"synthetic data test 4", false, 13.8e6, 1.83e6, 4},
    {"synthetic data test 5", false, 0.536e6, 0.0261e6, 3.5},
};

}  // namespace surf::workflow
