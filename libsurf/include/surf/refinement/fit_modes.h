// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/core/placement.h"
#include "surf/refinement/mesh_modes.h"

namespace surf {

/// What a mode changes in an image, by two simulations with random numbers of their own, per nm:
/// the pixels (row-major) that may change, and both changes.
struct ModeEffect {
  std::vector<std::uint32_t> pixels;
  std::vector<double> first, second;
};

/// An image and what is simulated of it at some surface.
struct RefinedView {
  Placement placement;
  Grid<double> measured;
  Mask used;               ///< pixels that count; empty: all
  Grid<double> simulated;  ///< in yields
  /// Two simulations with random numbers of their own, of which `simulated` is the mean; empty: it
  /// has no chance. Their products have no chance's square, which would look like information and
  /// like contrast.
  Grid<double> first_half, second_half;
  Grid<double> variance;  ///< of `measured`, and of `simulated` times the gain squared, > 0
  std::vector<ModeEffect> effects;  ///< of each mode, in yields
  ModeEffect tilt_x, tilt_y;        ///< of the beam's tilt, per degree; empty: it is not fitted
  double tilt_error_deg = 0;        ///< prior of the tilts
  double shift_x_nm = 0, shift_y_nm = 0;  ///< where the image is thought to be
  double shift_error_nm = 0;              ///< standard error of that, > 0
  /// What simulations are off by over wide parts of the image, as bumps that add up to 1 (two
  /// distances wide each): their standard deviation in measured units; 0: nothing.
  double wide_error = 0, wide_nm = 40;
  /// The relation between simulated and true yields may bend: by how much at one standard deviation
  /// of the image from its mean, over that deviation. A prior deviation; 0: it does not.
  double bend_error = 0;
  /// The true image may be more or less blurred, by a Gaussian of this variance: a prior deviation;
  /// 0: it is not.
  double blur_error_nm2 = 0;
};

/// Gain, offset and place of an image. Its measured values at a place are gain times the simulated
/// ones at the place less the shift, plus the offset.
struct RefinedViewState {
  double gain = 1, offset = 0;
  double shift_x_nm = 0, shift_y_nm = 0;  ///< what is to be added to the image's frame
  double tilt_x_deg = 0, tilt_y_deg = 0;
  std::vector<double> wide;       ///< what simulations are off by, one per bump; empty: 0
  double bend = 0, blur_nm2 = 0;  ///< likewise, see `RefinedView`
};

struct ModeFit {
  std::vector<double> amplitudes_nm;  ///< of each mode
  std::vector<double> covariance;     ///< of the amplitudes, row-major
  std::vector<RefinedViewState> views;
  /// What each view alone tells of each mode: one over the variance that its amplitude would have
  /// if all else were known, 1/nm^2.
  std::vector<std::vector<double>> information;
  double step = 0;      ///< the largest change of an amplitude over its prior deviation
  double move = 0;      ///< likewise over its deviation after the fit
  double promised = 0;  ///< what the step changes `misfit` by, to the second order; not above 0
};

/// Gain and offset of an image by the weighted least squares of its pixels.
void fit_gain(const RefinedView& view, RefinedViewState& state);

/// What a simulation of the view is off by at each pixel by its state, in measured units.
Grid<double> simulation_error(const RefinedView& view, const RefinedViewState& state,
                              const Grid<double>& simulated);

/// The view as a Gaussian of `sigma_px` pixels (>= 0) blurs it, measured and simulated alike, so
/// that steps reach farther than an edge is wide. Effects must be of all pixels in their order, or
/// of none.
RefinedView blurred(const RefinedView& view, double sigma_px);

/// One step of Gauss and Newton: the likeliest amplitudes, gains, offsets, shifts and tilts of all
/// images to the first order about the present ones. `amplitudes_nm` are those at which the images
/// were simulated; `prior` their covariance beforehand. What chance makes of an effect does not
/// count: only what both simulations of it have in common. `damping` (>= 0, in units of the prior's
/// weight; Levenberg 1944, Marquardt 1963) shortens the step, the less an image tells of a
/// direction the more; not the covariance. Throws InvalidInput for sizes that do not match.
ModeFit fit_modes(const std::vector<RefinedView>& views,
                  const std::vector<RefinedViewState>& states,
                  const std::vector<double>& amplitudes_nm, const std::vector<double>& prior,
                  double damping = 0);

/// Minus twice the log of the posterior density, but for a constant and without the simulations'
/// chance: what `fit_modes` makes small.
double misfit(const std::vector<RefinedView>& views, const std::vector<RefinedViewState>& states,
              const std::vector<double>& amplitudes_nm, const std::vector<double>& prior);

/// Standard deviation of the displacement of each vertex along its normal.
std::vector<double> vertex_deviations(const TriangleMesh& mesh, const std::vector<MeshMode>& modes,
                                      const std::vector<double>& covariance);

}  // namespace surf
