// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/noise.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/progress.h"

namespace surf {

/// A noise model with one standard error of each of its numbers.
struct NoiseEstimate {
  AfmNoise noise;
  double alpha_stderr = 0;
  double innovation_stderr_nm2 = 0;
  double sigma_stderr_nm =
      0;                    ///< of the standard deviation of the noise, sqrt(noise.variance_nm2())
  std::size_t samples = 0;  ///< that the estimate rests on
  bool alpha_at_limit = false;  ///< of `estimate_noise`: structure looks like noise, see there
  double sigma_nm() const;
};

struct FlatNoiseOptions {
  /// Degree of the polynomial that is removed first, 0 to 6: 2 removes tilt and bow of the scanner
  /// (thesis, 8.1.1). The heights may be the residuals of a levelled image as well.
  int degree = 2;

  Watch watch;  ///< of `estimate_substrate_noise`: the search for the plane
};

/// The model of a scan of something flat: alpha = r(1) / r(0) within rows and innovation
/// (1 - alpha^2) r(0), with the autocovariances of what is left when a polynomial is removed, made
/// up for the share of the noise that goes with the polynomial. Samples that are 0 in `use` (same
/// size, or empty) and holes play no part: pairs that touch them are left out. Standard errors are
/// those of a Gaussian AR(1) process (Brockwell and Davis 1991, 8.1), so they do not know of
/// structure or drift left in the heights. Throws InvalidInput if there are fewer than 16 samples
/// more than the polynomial has coefficients or no two beside each other, UsageError for a degree
/// out of range.
NoiseEstimate estimate_flat_noise(const HeightField& field, const FlatNoiseOptions& options = {},
                                  const Mask& use = {});

/// The model of the noise of an image with structure, without levelling. Looks at second
/// differences across three rows of second differences along rows, D_k = d_y^2 d_x,k^2 z with k = 1
/// to 4 columns between, which vanish wherever the surface is f(x) + y g(x) or f(y) + x g(y) or a
/// sum of such: any tilt, row offsets, edges along the axes. Places where any |D_k| is above four
/// of its standard deviations (begun with the median, then repeated) are left out; what remains is
/// fitted by var D_k = 12 s^2 (1 - a^k) (3 - a^k).
///
/// Structure of the size of a few pixels counts as noise in part, so on rough surfaces the estimate
/// is too large, never too small but for chance; docs/methods/noise.md tells by how much.
/// Differences over so few columns hardly tell strong correlation from structure: alpha is at most
/// 0.9, and `alpha_at_limit` then says that structure is likely to dominate. The innovation suffers
/// less from it than sigma. Rows are taken as independent. Standard errors come from leaving out
/// bands of rows (jackknife). Noiseless heights give an innovation of 0. Throws InvalidInput if no
/// 5 x 3 samples without holes are there (9 x 3 in fields at least 9 wide).
NoiseEstimate estimate_noise(const HeightField& field);

}  // namespace surf
