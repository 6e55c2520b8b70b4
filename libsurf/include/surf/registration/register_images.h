// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/affine.h"
#include "surf/core/placed_image.h"
#include "surf/core/progress.h"

namespace surf {

/// The measure of agreement that the registration maximises.
enum class RegistrationObjective {
  correlation,         ///< normalised cross-correlation: intensities rise linearly with each other
  mutual_information,  ///< works for any relation of intensities (thesis, appendix F)
};

/// The width of bins of intensities, for N values (thesis, appendix F).
enum class BinRule {
  interquartile,  ///< 2 IQR N^-1/3 (Freedman and Diaconis)
  deviation,      ///< 3.49 sigma N^-1/3 (Scott)
};

enum class EntropyEstimate {
  histogram,
  /// Densities from half of the samples by Gaussian windows as wide as the rule's bins, averaged
  /// over the other half.
  parzen,
};

struct MutualInformationOptions {
  EntropyEstimate estimate = EntropyEstimate::histogram;
  BinRule bins = BinRule::interquartile;
  /// True: a place between samples counts for all four neighbours. False: it counts for its
  /// interpolated intensity.
  bool partial_volume = true;
};

struct RegistrationOptions {
  RegistrationObjective objective = RegistrationObjective::correlation;
  MutualInformationOptions mutual_information;  ///< unused with correlation

  /// Standard deviations of the blur of both images, in SEM pixels, in the order in which they are
  /// used (thesis, 7.2.5).
  std::vector<double> blurs_px = {8, 5, 4, 3, 2, 1, 0};

  /// Initial map from SEM to AFM, for example from landmarks. Without it the initial map is
  /// searched for within the following limits.
  std::optional<Affine> start;
  /// Scale of the SEM's lengths in the AFM's frame.
  double least_scale = 0.75, largest_scale = 1.35;
  double largest_shear = 0.06;
  double least_overlap = 0.4;  ///< share of the smaller image that must lie in the other, (0, 1]

  /// A second optimum is a rival if its score is within this many standard errors of the best
  /// score.
  double rival_sigmas = 4;

  /// The result is ambiguous if its standard error (root mean square over the overlap, in SEM
  /// pixels) is larger than this.
  double largest_stderr_px = 0.4;

  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

enum class RegistrationVerdict {
  verified,     ///< converged, and no other map fits nearly as well
  ambiguous,    ///< another map, or a continuum of maps, fits as well: see `rivals`
  unconverged,  ///< the optimiser did not settle, or settled at a limit
  /// The images do not overlap, or agree nowhere more than chance allows.
  unrelated,
};

struct RegistrationRival {
  Affine sem_to_afm;
  double score = 0;
  /// Root mean square distance from the best map over the overlap, SEM pixels.
  double distance_px = 0;
};

/// The refinement at one blur.
struct RegistrationStep {
  double blur_px = 0, score = 0;
  double moved_px = 0;  ///< root mean square displacement over the overlap
  int evaluations = 0;
};

struct Registration {
  RegistrationVerdict verdict = RegistrationVerdict::unconverged;
  Affine sem_to_afm;
  double score = 0;    ///< correlation in [-1, 1], or mutual information in nats, at `blur_px`
  double blur_px = 0;  ///< blur of both images at which the map is known best
  std::array<double, 36> covariance{};  ///< of xx xy x0 yx yy y0, row-major
  /// Standard error of the mapped position, root mean square over the overlap. Includes the effect
  /// of the tip on edges; rather too large than too small.
  double stderr_px = 0;
  /// Along some motion the images hold too little to tell the place: they slide on each other.
  bool slides = false;
  double overlap = 0;                     ///< share of the SEM's pixels inside the AFM's image
  std::vector<RegistrationRival> rivals;  ///< best first
  std::vector<RegistrationStep> steps;
  std::string reason;  ///< reason for the verdict, for people: one sentence, and what to do
};

/// Finds the affine map that aligns the real SEM image with the image that is simulated from the
/// AFM's surface (thesis, chapter 7). Throws InvalidInput for invalid images and images of one
/// colour, UsageError for options out of range, Interrupted.
Registration register_images(const PlacedImage& sem, const PlacedImage& simulated,
                             const RegistrationOptions& options = {});

}  // namespace surf
