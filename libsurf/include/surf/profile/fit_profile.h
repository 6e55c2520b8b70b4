// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "surf/core/placed_image.h"
#include "surf/core/progress.h"
#include "surf/profile/edge_roughness.h"
#include "surf/profile/image_edges.h"
#include "surf/profile/profile_library.h"

namespace surf {

/// A pixel of an edge: its row along the edge, and its place across it.
struct ProfileSample {
  int edge = 0, row = 0;
  double x_nm = 0, value = 0;
};

/// What is fitted: pixels of edges that lie at equal distances along them.
struct ProfileData {
  std::vector<ImageEdge> edges;
  std::vector<ProfileSample> samples;
  int rows = 0;
  double row_distance_nm = 1;
  bool closed = false;  ///< the rows run around a hole
};

/// The pixels of an image whose lines run along y.
ProfileData profile_data(const PlacedImage& image, const std::vector<ImageEdge>& edges);
/// The pixels around a hole, up to a distance from its middle: rows are directions, x is the
/// distance.
ProfileData profile_data(const PlacedImage& image, const Circle& hole, double to_nm);
/// The pixels beside a cut through a hole: rows run along the cut, x is the distance from the
/// hole's middle, of the wall at its other side negative. Places beside the cut are moved outward
/// as the rim bends away from it, so that both walls are straight.
ProfileData profile_data(const PlacedImage& image, const HoleCut& cut);

/// An image that is fitted, and what simulated signals of its walls are like.
struct ProfileSight {
  ProfileData data;
  /// Of walls with the ground at their left, and at their right; with one box. They must outlive
  /// the fit.
  const ProfileLibrary *left = nullptr, *right = nullptr;
  double tilt_deg = 0;        ///< of the beam, which the libraries know
  double azimuth_deg = 0;     ///< of the beam, from x; lines run along y
  double tilt_error_deg = 0;  ///< standard error of the tilt, which is fitted; 0: it is right
  /// Each edge is sought so far from its place by itself; 0: all together, some nanometres.
  double search_nm = 0;
  /// Images of one signal at one energy have one number: their simulations are off by about the
  /// same, the less they differ in tilt.
  int signal = 0;
  /// It tells heights by shading alone, which physics differ in: see `shading_doubt_nm`.
  bool shows_shading_alone = false;
};

struct ProfileFitOptions {
  bool walls_alike = true;  ///< left and right walls have one shape
  /// All images show the same one, whose width is one number, to 0.5 % by the images' scales.
  bool one_feature = false;
  /// Priors of the numbers: normal, with these deviations; 0: held at the mean, infinite: none. The
  /// width follows from the edges' places.
  ProfileNumbers prior_mean{}, prior_deviation{};
  /// The height stays at its prior's mean, and the prior's deviation enters all errors: for heights
  /// that are known better than images tell them (a consider parameter: Tapley, Schutz and Born,
  /// Statistical Orbit Determination, 2004, section 6.2).
  bool hold_height = false;
  /// Images that show shading alone see the height off by one number, normal with this deviation;
  /// how far flanks run they see right. 0: none.
  double shading_doubt_nm = 0;
  /// What the simulation may be off by: a share of the signal's contrast, correlated over some nm,
  /// as much again over ten times as many. How much of it there is, a quarter or more, is measured
  /// where the height is known to 5 %.
  double model_error = 0.08, model_error_nm = 4;
  Watch watch;
};

/// A number with its standard error.
struct Measured {
  double value = 0, standard_error = 0;
};

struct FittedEdge {
  ImageEdge edge;
  Measured place_nm;              ///< mean of its rows
  std::vector<double> smooth_nm;  ///< place of each row, as far as it stands out of the noise
  std::vector<double> rows_nm;    ///< place of each row
  std::vector<double> errors_nm;  ///< their standard errors
};

/// A measured signal across an edge, and what the fit makes of it, at distances u from the edge.
struct MeanProfile {
  bool material_right = true;  ///< of walls with the ground at their left
  std::vector<double> u_nm, measured, standard_error, fitted;
};

/// What is fitted of an image, and how it agrees.
struct SightFit {
  std::vector<FittedEdge> edges;
  double gain = 1, offset = 0;
  double blur_nm = 0;  ///< what rows are displaced by that alignment did not follow
  Measured tilt_deg;
  std::vector<MeanProfile> profiles;  ///< of left and right walls
  /// What the simulation is off by, root mean square over the signal's contrast.
  double discrepancy_share = 0;
  /// What the simulated signal, with gain and offset alone, leaves of the mean profiles' variation:
  /// root mean square over that variation. 1: it explains nothing.
  double unexplained_share = 0;
};

struct ProfileFit {
  std::vector<SightFit> sights;  ///< of each image; the first's edges and roughness are below
  /// Of the walls with the ground at their left (`left`) and at their right; the same if walls are
  /// alike, or are seen from one side only.
  /// The order of ProfileNumbers; a width's standard error is that of the mean width.
  std::array<Measured, profile_numbers> left, right;
  std::vector<Measured> widths_nm;  ///< of each feature with two edges, or a hole's diameter
  EdgeRoughness edge_roughness, width_roughness;
  EdgeSpectrum edge_spectrum, width_spectrum;
  bool converged = false;
  bool at_border = false;  ///< width or a number without a prior is at the border of the box

  const std::vector<FittedEdge>& edges() const { return sights.front().edges; }
};

/// Fits one shape to all images, and of each gain, offset, tilt and the place of each edge in each
/// row. Images need not show the same features. Places of rows are smoothed by
/// the roughness that they show, so that noise does not align itself; what this leaves blurs the
/// model. Throws InvalidInput for data without samples at an edge, Interrupted.
ProfileFit fit_profile(const std::vector<ProfileSight>& sights, const ProfileFitOptions& options);
/// The same for an image that is seen from above.
ProfileFit fit_profile(const ProfileData& data, const ProfileLibrary& library,
                       const ProfileFitOptions& options);

}  // namespace surf
