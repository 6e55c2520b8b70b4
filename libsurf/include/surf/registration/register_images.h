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

/// What is largest where two images agree.
enum class RegistrationObjective {
  correlation,  ///< normalised cross-correlation: intensities are a rising line of each other
  mutual_information,  ///< any relation of intensities (thesis, appendix F)
};

/// How wide bins of intensities are, for N values (thesis, appendix F).
enum class BinRule {
  interquartile,  ///< 2 IQR N^-1/3 (Freedman and Diaconis)
  deviation,      ///< 3.49 sigma N^-1/3 (Scott)
};

enum class EntropyEstimate {
  histogram,
  parzen,  ///< densities by Gaussian windows, as wide as the rule's bins, from half of the samples
           ///< and averaged over the other half
};

struct MutualInformationOptions {
  EntropyEstimate estimate = EntropyEstimate::histogram;
  BinRule bins = BinRule::interquartile;
  bool partial_volume =
      true;  ///< a place between samples counts for all four; false: for its own intensity
};

struct RegistrationOptions {
  RegistrationObjective objective = RegistrationObjective::correlation;
  MutualInformationOptions mutual_information;  ///< unused with correlation

  /// Standard deviations of the blur of both images, in SEM pixels, in the order of use
  /// (thesis, 7.2.5).
  std::vector<double> blurs_px = {8, 5, 4, 3, 2, 1, 0};

  /// Where to begin, SEM to AFM, as from landmarks; absent: the start is searched for, among the
  /// following.
  std::optional<Affine> start;
  double least_scale = 0.75, largest_scale = 1.35;  ///< of the SEM's lengths in the AFM's frame
  double largest_shear = 0.06;
  double least_overlap = 0.4;  ///< share of the smaller image that must lie in the other, in (0, 1]

  /// A second optimum whose score is closer to the best than so many of its standard errors is a
  /// rival.
  double rival_sigmas = 4;

  /// A place whose standard error is larger, SEM pixels, root mean square over the overlap, is
  /// ambiguous.
  double largest_stderr_px = 0.4;

  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

enum class RegistrationVerdict {
  verified,     ///< converged, and no other place fits nearly as well
  ambiguous,    ///< another place, or a whole line of places, fits as well: see `rivals`
  unconverged,  ///< the optimiser did not settle, or settled at a limit
  unrelated,    ///< no place where the images agree more than chance allows, or they do not overlap
};

struct RegistrationRival {
  Affine sem_to_afm;
  double score = 0;
  double distance_px = 0;  ///< root mean square over the overlap, SEM pixels from the best
};

/// One blur of the refinement.
struct RegistrationStep {
  double blur_px = 0, score = 0;
  double moved_px = 0;  ///< root mean square over the overlap
  int evaluations = 0;
};

struct Registration {
  RegistrationVerdict verdict = RegistrationVerdict::unconverged;
  Affine sem_to_afm;
  double score = 0;    ///< correlation in [-1, 1], or mutual information in nats, at `blur_px`
  double blur_px = 0;  ///< of both images: of the finest ones, where the map is known best
  std::array<double, 36> covariance{};  ///< of xx xy x0 yx yy y0, row-major
  double stderr_px = 0;  ///< root mean square over the overlap of the place's standard error, with
                         ///< what a tip does to edges: rather too large than too small
  double overlap = 0;    ///< share of the SEM's pixels that lie in the AFM's image
  std::vector<RegistrationRival> rivals;  ///< best first
  std::vector<RegistrationStep> steps;
  std::string reason;  ///< of the verdict, for people: one sentence, and what to do
};

/// The affine map that lays the real SEM image on the one that is simulated from the AFM's surface
/// (thesis, chapter 7). Throws InvalidInput for invalid images and images of one colour, UsageError
/// for options out of range, Interrupted.
Registration register_images(const PlacedImage& sem, const PlacedImage& simulated,
                             const RegistrationOptions& options = {});

}  // namespace surf
