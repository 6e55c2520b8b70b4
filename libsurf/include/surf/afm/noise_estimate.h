// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/noise.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/progress.h"

namespace surf {

/// A noise model with the standard errors of its numbers.
struct NoiseEstimate {
  AfmNoise noise;
  double alpha_stderr = 0;
  double innovation_stderr_nm2 = 0;
  /// Standard error of `sigma_nm()`.
  double sigma_stderr_nm = 0;
  std::size_t samples = 0;      ///< number of samples that the estimate uses
  bool alpha_at_limit = false;  ///< `estimate_noise` only: structure probably dominates, see there
  double sigma_nm() const;
};

struct FlatNoiseOptions {
  /// Degree of the polynomial that is removed first, 0 to 6: 2 removes tilt and bow of the scanner
  /// (thesis, 8.1.1). The heights may be the residuals of a levelled image as well.
  int degree = 2;

  Watch watch;  ///< for the plane search of `estimate_substrate_noise`
};

/// Estimates the noise from a scan of a flat sample. A polynomial is removed first. With the
/// autocovariances r of the residual, alpha = r(1) / r(0) within rows and the innovation is (1 -
/// alpha^2) r(0); both are corrected for the share of the noise that the polynomial removes. Holes
/// and samples that are 0 in `use` (same size, or empty) do not count, nor do pairs that contain
/// them. Standard errors are those of a Gaussian AR(1) process (Brockwell and Davis 1991, 8.1);
/// they do not include structure or drift that is left in the heights. Throws InvalidInput if there
/// are fewer than 16 samples more than polynomial coefficients, or no two neighbouring samples;
/// UsageError for a degree out of range.
NoiseEstimate estimate_flat_noise(const HeightField& field, const FlatNoiseOptions& options = {},
                                  const Mask& use = {});

/// Estimates the noise of an image with structure, without levelling. It uses second differences
/// across three rows of second differences along rows, D_k = d_y^2 d_x,k^2 z with columns k = 1 to
/// 4 apart. They vanish where the surface is f(x) + y g(x) or f(y) + x g(y) or a sum of these: any
/// tilt, row offsets, edges along the axes. Places where any |D_k| exceeds four of its standard
/// deviations are left out; the first standard deviations come from the median, the next ones from
/// the remaining places. The remaining variances are fitted by var D_k = 12 s^2 (1 - a^k) (3 -
/// a^k).
///
/// Structure that is a few pixels wide counts partly as noise, so the estimate is too large on
/// rough surfaces; it is too small only by chance (docs/explanation/noise.md says by how much).
/// Sixth differences across rows bound it: where their median says clearly less, that is the
/// result. Differences over so few columns hardly distinguish strong correlation from structure:
/// |alpha| is limited to 0.9, and `alpha_at_limit` then says that structure is likely to dominate.
/// The innovation is less affected than sigma. Rows are assumed independent. Standard errors come
/// from a jackknife over bands of rows. Noiseless heights give an innovation of 0. Throws
/// InvalidInput if there are no 5 x 3 samples without holes (7 x 3 or 9 x 3 in fields at least 7 or
/// 9 wide).
NoiseEstimate estimate_noise(const HeightField& field);

}  // namespace surf
