// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "surf/sem/image_model.h"

namespace surf {

/// The number of moments of the directions v in which electrons move at a place, in cylinder
/// coordinates about the beam: v_r, v_z, v_r^2, v_phi^2, v_z^2, v_r v_z. Each is a path length per
/// volume and primary (counts per nm^2).
inline constexpr std::size_t diffusion_moments = 6;

struct DiffusionMatrixChannel {
  std::string name;
  /// [ring][height][moment], averages over a ring and over one step of height centred on the
  /// height. Ring k extends from k ring_nm to (k + 1) ring_nm; heights are lowest_nm, lowest_nm +
  /// height_step_nm ...
  std::vector<double> moments_per_nm2;
};

struct DiffusionMatrixParameters {
  double ring_nm = 1;                            ///< > 0
  double lowest_nm = 0;                          ///< relative to the place where the beam enters
  double height_step_nm = 1;                     ///< > 0
  int rings = 0;                                 ///< 1 to 4096
  int heights = 0;                               ///< 2 to 4096
  std::vector<DiffusionMatrixChannel> channels;  ///< 1 to 8
};

/// The diffusion matrix (Desai 1990, Czyzewski 1991; thesis, 2.2.2) on height fields. A channel is
/// the outward flux through the facets of all surrounding pixels, as if matter were everywhere.
///
/// The original method tabulates the flux for a choice of orientations. Here the flux for any
/// orientation is computed from moments: the flux out of a facet with the normal n is 1/2 (mean of
/// v n + mean of |v n|). |c| is approximated by 3/16 + 15/16 c^2 (Legendre polynomials of degree 0
/// and 2). This is exact if the distribution of directions has degree 3 at most, and its error
/// never exceeds 3/16. Moments are averaged over a pixel's column and are smooth in height
/// (quadratic B-splines). A facet has its pixel's height, and its slope by central differences.
///
/// The model neglects electrons that leave the surface and enter it again. It counts an electron
/// that crosses the surface several times each time it goes out. The scope needs a pixel size, and
/// the rings may extend over at most `most_diffusion_columns` pixels. Throws InvalidInput for
/// parameters out of range.
std::shared_ptr<const ImageModel> make_diffusion_matrix(
    const ModelScope& scope, const DiffusionMatrixParameters& parameters);

inline constexpr int most_diffusion_columns = 40;

}  // namespace surf
