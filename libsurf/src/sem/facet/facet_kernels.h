// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/sem/filter_bank.h"

namespace surf {

/// The one-dimensional factors of the cubic facet fit along one axis (thesis, D.1 and D.2, written
/// with the orthogonal polynomials of the weights). A factor is given at offsets 0 to radius: e0
/// and e2 are even, o1 and o3 odd. With y for rows and x for columns, and heights and pitches in
/// nm, the coefficients of the fit are
///     K2 (slope along y)                        = o3_y e0_x - mix_x o1_y e2_x
///     K3 (slope along x)                        = e0_y o3_x - mix_y e2_y o1_x
///     K4 (half the second derivative along y)   = e2_y e0_x
///     K5 (mixed second derivative)              = o1_y o1_x
///     K6 (half the second derivative along x)   = e0_y e2_x
/// each as a sum of factor times height over the neighbourhood.
struct FacetKernel {
  int radius = 0;
  std::vector<double> e0;  ///< mean
  std::vector<double> o1;  ///< slope of the best line, 1/nm
  std::vector<double> e2;  ///< half the second derivative of the best parabola, 1/nm^2
  std::vector<double> o3;  ///< slope at the centre of the best cubic, 1/nm
  double mix = 0;          ///< mean square offset, nm^2
};

/// Throws InvalidInput for an even size, a size outside 5 to 255, and a sigma that is neither 0 nor
/// 0.3 to 1000. Narrower weights cannot distinguish a cubic from a line.
FacetKernel facet_kernel(const FacetScale& scale, double pitch_nm);

}  // namespace surf
