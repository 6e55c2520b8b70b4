// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/afm/tip.h"
#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/reconstruction/image_data.h"
#include "surf/reconstruction/view.h"

namespace surf {

enum class ReconstructionMethod {
  gauss_newton,         ///< matrix-free, with a trust region
  conjugate_gradients,  ///< Polak-Ribiere with a strong Wolfe line search, as in the thesis
  lbfgs,
};

/// What the SEM image may be displaced by on the scan because its place is not certain: variances
/// along x and y of the surface, and their covariance, pixels squared.
struct PlaceDoubt {
  double along_x = 0, along_y = 0, both = 0;
};

struct ReconstructionOptions {
  ReconstructionMethod method = ReconstructionMethod::gauss_newton;

  /// For the descents: standard deviations of the Gaussians that the surface is a sum of, in pixels
  /// of the surface, falling. For Gauss-Newton, whose unknowns are the heights: the curvature of
  /// the prior is multiplied by the scale's square, so that wide scales come first and give a
  /// smooth surface. Empty: the method's defaults (`default_scales_px`).
  std::vector<double> scales_px;
  int iterations = 0;  ///< per scale, at most; 0: the method's default
  /// > 0: a scale ends when an iteration (of descents, three in a row) lowers the objective by less
  /// than this per pixel; 0: the method's default.
  double tolerance = 0;

  /// Prior: the scale of the surface's second derivative, 1 / nm, multiplied by the square of the
  /// scale (see `scales_px`). The second derivative follows Student's t with one degree of freedom.
  /// 0: 1e-3, which is 2e-3 at the end. On rough ground, which is curved everywhere, a larger value
  /// is used: three times the curvature that the surface itself makes most likely.
  double curvature_prior_per_nm = 0;

  /// The specimen is known to bend everywhere: the prior is replaced from the beginning, not only
  /// where a surface made under the usual one bends as much.
  bool rough_ground = false;

  PlaceDoubt place_doubt = {};  ///< counts in the deviations alone

  bool refine_transform = true;  ///< the map is fitted together with the surface
  /// A drift of the scan that is not steady is fitted with the map: a parabola along its slow axis.
  bool refine_drift = false;
  /// The spot's width is fitted, too, from the model's on. The image tells it badly: a wider spot
  /// and a duller tip make much the same of it.
  bool refine_spot = false;
  bool refine_calibration = true;  ///< the offset and a common factor of all gains are fitted, too
  /// The tip is fitted, too, starting from the given one: seven factors of its slope, between the
  /// apex and the rim. Only for Gauss-Newton with both images: the SEM image shows how far the tip
  /// kept off the walls, which no scan alone does.
  bool refine_tip = false;
  bool uncertainty = true;  ///< compute `deviation_nm`
  int probes = 6;           ///< draws for the estimate of the uncertainty, >= 2
  std::uint64_t seed = 1;   ///< seed of these draws
  int threads = 0;          ///< 0: one per hardware thread. Does not change the result
  /// Gauss-Newton's preconditioner is factorised in double precision throughout, for comparisons.
  /// false: in single precision, which takes half the time and memory, except where that is too
  /// coarse (see `ScaleReport::double_factors`).
  bool double_precision = false;
  Watch watch;
};
/// Describes the parameters reconstruction.optimiser, reconstruction.scales and so on, but neither
/// the threads nor the precision.
void describe(ParameterVisitor& visit, ReconstructionOptions& options);

struct ScaleReport {
  double sigma_px = 0;
  double curvature_prior_per_nm = 0;  ///< prior at the end of the scale
  /// Terms of the objective: negative log-likelihoods, without constants.
  double afm = 0, sem = 0, prior = 0;
  double gradient_norm = 0;  ///< largest component of the gradient by the coefficients
  /// Evaluations of objective and gradient, and products of a Hessian and a vector.
  int iterations = 0, evaluations = 0, products = 0;
  /// Factors of the preconditioner's tiles, and those of them in double precision, because the
  /// tile's matrix cannot be solved in single precision, or because it was asked for.
  int factors = 0, double_factors = 0;
  std::string ended;  ///< why the scale ended: "converged", "iterations" or "line search"
  ResidualReport afm_residual, sem_residual;
};

/// What is fitted of a view besides the surface.
struct ViewState {
  std::vector<double> pose_change;  ///< from the given pose
  std::vector<double> gains;
  double offset = 0;
};

/// The state that the next scale starts from.
struct ReconstructionState {
  HeightField surface;
  Affine sem_to_afm;
  std::vector<double> gains;
  double offset = 0, blur_px2 = 0, film_nm = 0;
  std::vector<ScaleReport> scales;  ///< the finished scales
  std::vector<double> tip_change;   ///< change from the given tip; empty: not fitted
  Point2 scan_drift_px{};
  std::vector<ViewState> views;
};

/// Stores states, so that an interrupted reconstruction can be resumed. It is called after each
/// scale.
class ReconstructionJournal {
 public:
  virtual ~ReconstructionJournal() = default;
  /// A stored state of the same reconstruction to resume from, if there is one.
  virtual std::optional<ReconstructionState> found() = 0;
  virtual void keep(const ReconstructionState& state) = 0;
};

/// The thickest film that is sought: what it changes is known to first order.
constexpr double largest_film_nm = 5;

/// Standard deviations of a map from SEM to AFM: of its parts (see AffineParts), and of where the
/// image's middle lies in the scan.
struct MapDeviation {
  double rotation_rad = 0, scale_x = 0, scale_y = 0, shear = 0;
  double middle_x_nm = 0, middle_y_nm = 0;
};

struct Reconstruction {
  /// In the SEM's frame and on its pixels, with the AFM's heights. With AFM data only: on the
  /// scan's samples.
  HeightField surface;
  Affine sem_to_afm;
  /// How well the map is known; none where it is not fitted, or deviations are not wanted.
  std::optional<MapDeviation> map_deviation;
  std::vector<double> gains;
  double offset = 0;
  /// By how much the real spot's variance along each axis exceeds the model's, in squared pixels,
  /// -0.4 to 2; 0: not fitted.
  double blur_px2 = 0;
  /// Likeliest thickness of the film, 0 to `largest_film_nm`; 0 as well without `SemData::film`.
  double film_nm = 0;
  /// What a scan that drifts unsteadily is displaced by, in pixels of the surface: 2/3 of it at the
  /// ends of the part in use, along the longer side, and -1/3 in the middle; 0: not fitted.
  Point2 scan_drift_px{};
  Tip tip;            ///< fitted or given tip, on the AFM's samples; empty without AFM
  HeightField start;  ///< initial surface: the eroded scan on the surface's samples

  /// On the AFM's samples; holes where the surface does not reach. Empty without AFM.
  HeightField simulated_afm;
  Grid<double> afm_residual;     ///< whitened
  Mask afm_used;                 ///< 1: the pixel contributes
  Grid<double> simulated_sem;    ///< on the surface's samples. Empty without SEM
  Grid<double> sem_residual;     ///< whitened, with the discrepancy taken off
  Grid<double> sem_discrepancy;  ///< what the model is off by, most likely. Empty without
  /// The likeliest displacements of rows, in the standard deviations of `SemData::row_jitter`.
  std::vector<double> sem_row_jitter;
  /// Its root mean square over the standard deviation of the simulated image.
  double sem_discrepancy_share = 0;
  std::vector<ViewResult> views;  ///< of further SEM images, as given

  /// Posterior standard deviation of each height, linearised; includes the bias by the prior, what
  /// the surface may be tilted by, and where its walls may be. Empty if not wanted.
  Grid<double> deviation_nm;
  /// 95 % of draws of each height lie between these two: quantiles of 2.5 and 97.5 % of draws of
  /// all unknowns. At edges and in narrow places they lie unevenly about the surface. Empty if not
  /// wanted.
  Grid<double> lower_nm, upper_nm;
  /// The data that support each height. 1: the tip touched it. 2: the SEM image at least halves the
  /// variance of the height. 3: both. 0: only its neighbours and the prior.
  Grid<unsigned char> data_support;
  std::vector<ScaleReport> scales;
  bool converged = true;
  /// For people; if there are any, look before you trust the result.
  std::vector<std::string> warnings;
};

/// The method's default scales for a surface with this many samples. For the descents: those of the
/// thesis's schedule from 60 to 0.39 pixels (Jones 1994) that are at most 10 pixels and at most a
/// third of the shorter side. Gauss-Newton has fewer.
std::vector<double> default_scales_px(ReconstructionMethod method, int width, int height);

/// Finds the surface that maximises the likelihood of both images, or of the given one (thesis,
/// chapter 9; docs/explanation/reconstruction.md). Throws InvalidInput for impossible data, or if
/// fewer than 256 AFM pixels (16 x 16) overlap the SEM image; UsageError for options out of range;
/// Interrupted.
Reconstruction reconstruct(const AfmData* afm, const SemData* sem,
                           const ReconstructionOptions& options = {},
                           ReconstructionJournal* journal = nullptr);

/// The same with further SEM images of the surface, from other sides (docs/explanation/views.md).
/// The first image is looked at from above: the surface is in its frame. Only Gauss-Newton knows
/// them.
Reconstruction reconstruct(const AfmData* afm, const SemData* sem,
                           const std::vector<SemView>& views, const ReconstructionOptions& options,
                           ReconstructionJournal* journal = nullptr);

/// The root-mean-square error of heights, nm, that noise and the prior alone would leave. It is the
/// error of one linear step at the true surface, for data with the described noise and correct
/// models, map and tip; the mean over `draws` draws of the noise. `truth` is on the surface's
/// samples (the SEM's pixels, or the AFM's samples without SEM). A mean difference counts, because
/// the AFM image determines the height. Throws as `reconstruct`.
double noise_floor_nm(const AfmData* afm, const SemData* sem, const HeightField& truth,
                      const ReconstructionOptions& options = {}, int draws = 2);

}  // namespace surf
