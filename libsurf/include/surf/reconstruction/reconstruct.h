// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/parameters.h"
#include "surf/core/placed_image.h"
#include "surf/core/progress.h"
#include "surf/sem/image_model.h"
#include "surf/sem/sem_noise.h"

namespace surf {

/// A levelled scan, and what is known of how it came about: image = dilation of the surface by the
/// tip + noise.
struct AfmData {
  HeightField image;
  Tip tip;  ///< of the image's pitch
  AfmNoise noise;
  int upsample = 3;  ///< the dilation is computed on so many samples per pitch (thesis, appendix
                     ///< C.3), in [1, 8]
};

/// An SEM image, and what is known of how it came about: image = sum of gain * channel of the model
/// + offset
/// + noise.
struct SemData {
  PlacedImage image;  ///< square pixels, as the model's
  std::shared_ptr<const ImageModel> model;
  std::vector<double> gains;  ///< one per channel of the model; 0 leaves a channel out
  double offset = 0;
  SemNoise noise;
  Affine sem_to_afm;
};

enum class ReconstructionMethod {
  gauss_newton,         ///< matrix-free, with a trust region
  conjugate_gradients,  ///< Polak-Ribiere with a strong Wolfe line search, as in the thesis
  lbfgs,
};

struct ReconstructionOptions {
  ReconstructionMethod method = ReconstructionMethod::gauss_newton;

  /// Of the descents: standard deviations of the Gaussians that the surface is a sum of, in pixels
  /// of the surface, falling. Of Gauss-Newton, whose unknowns are the heights: the prior's
  /// curvature is multiplied by a scale's square, so that wide ones come first as a smooth surface.
  /// Empty: the method's own
  /// (`default_scales_px`).
  std::vector<double> scales_px;
  int iterations = 0;    ///< of each scale, at most; 0: the method's own
  double tolerance = 0;  ///< > 0: a scale ends when an iteration lowers the objective by less than
                         ///< this per pixel; 0: the method's own

  /// Prior: the scale of the surface's second derivative, 1 / nm, Student's t with one degree of
  /// freedom, multiplied by the scale's square, see above. 0: 1e-3, so 2e-3 at the end, and what
  /// the surface itself makes most likely where that is more, as on rough ground, which bends
  /// everywhere.
  double curvature_prior_per_nm = 0;

  bool refine_transform = true;    ///< the map is fitted further with the surface
  bool refine_calibration = true;  ///< and so are the offset and a factor of all gains
  /// The tip is fitted, too, from the one that is given: seven factors of its slope, between the
  /// apex and the rim. Of Gauss-Newton with both images; the SEM image tells how far the tip kept
  /// off the walls, which no scan alone does.
  bool refine_tip = false;
  bool uncertainty = true;  ///< compute `deviation_nm`
  int probes = 6;           ///< draws that the uncertainty is estimated from, >= 2
  std::uint64_t seed = 1;   ///< of these
  int threads = 0;          ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};
/// reconstruction.optimiser, reconstruction.scales and so on; not the threads.
void describe(ParameterVisitor& visit, ReconstructionOptions& options);

/// How an image's whitened residuals look: standard normal and white if all is right.
struct ResidualReport {
  double mean = 0, deviation = 1;
  double along = 0, across = 0;  ///< correlation of neighbours along and across rows
  std::int64_t pixels = 0;
  bool like_noise = true;
};

struct ScaleReport {
  double sigma_px = 0;
  double curvature_prior_per_nm = 0;  ///< that the scale ended with
  double afm = 0, sem = 0,
         prior = 0;  ///< terms of the objective: negative log-likelihoods, without constants
  double gradient_norm = 0;  ///< largest component, per coefficient
  int iterations = 0, evaluations = 0,
      products = 0;   ///< of objective and gradient; of a Hessian and a vector
  std::string ended;  ///< why: "converged", "iterations"
  ResidualReport afm_residual, sem_residual;
};

/// All that the next scale needs.
struct ReconstructionState {
  HeightField surface;
  Affine sem_to_afm;
  std::vector<double> gains;
  double offset = 0;
  std::vector<ScaleReport> scales;  ///< those done
  std::vector<double> tip_change;   ///< of the tip from the one given; empty: not fitted
};

/// Who keeps states, so that an interrupted run goes on: told after each scale.
class ReconstructionJournal {
 public:
  virtual ~ReconstructionJournal() = default;
  virtual std::optional<ReconstructionState>
  found() = 0;  ///< a state of this very reconstruction, to go on from
  virtual void keep(const ReconstructionState& state) = 0;
};

struct Reconstruction {
  HeightField surface;  ///< in the SEM's frame and on its pixels, heights as the AFM's; AFM only:
                        ///< on its samples
  Affine sem_to_afm;
  std::vector<double> gains;
  double offset = 0;
  Tip tip;            ///< as fitted, else as given, on the AFM's samples; empty without AFM
  HeightField start;  ///< what it began with: the eroded scan on the surface's samples

  HeightField simulated_afm;   ///< on the AFM's samples; holes where the surface does not reach.
                               ///< Empty without AFM
  Grid<double> afm_residual;   ///< whitened
  Mask afm_used;               ///< 1: the pixel plays a part
  Grid<double> simulated_sem;  ///< on the surface's samples. Empty without SEM
  Grid<double> sem_residual;   ///< whitened

  Grid<double> deviation_nm;  ///< of each height, linearised: noise and the prior's pull; empty if
                              ///< not asked for
  /// What holds each height: 1 the tip touched it, 2 the SEM image halves its prior's variance at
  /// least; both: 3; 0: nothing but its neighbours and the prior.
  Grid<unsigned char> held_by;
  std::vector<ScaleReport> scales;
  bool converged = true;
  std::vector<std::string> warnings;  ///< for people; not empty: look before you trust the result
};

/// The method's own scales for a surface so many samples across: for the descents those of the
/// thesis's schedule, 60 to 0.39 pixels (Jones 1994), that are below 10, fewer for Gauss-Newton.
std::vector<double> default_scales_px(ReconstructionMethod method, int width, int height);

/// The surface that makes both images, or the one that is there, most likely (thesis, chapter 9;
/// docs/methods/reconstruction.md). Throws InvalidInput for impossible data, or where the images do
/// not overlap by 16 pixels, UsageError for options out of range, Interrupted.
Reconstruction reconstruct(const AfmData* afm, const SemData* sem,
                           const ReconstructionOptions& options = {},
                           ReconstructionJournal* journal = nullptr);

/// The root-mean-square error of heights, nm, that noise and the prior alone would leave: of one
/// linear step at the true surface, for data whose noise is as described and whose models, map and
/// tip are right; the mean over `draws` of the noise. `truth` is on the surface's samples (the
/// SEM's pixels, or the AFM's samples without one). A mean difference counts, as the AFM image
/// knows the height. Throws as `reconstruct`.
double noise_floor_nm(const AfmData* afm, const SemData* sem, const HeightField& truth,
                      const ReconstructionOptions& options = {}, int draws = 2);

}  // namespace surf
