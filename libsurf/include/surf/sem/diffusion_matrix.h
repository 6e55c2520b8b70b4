// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "surf/sem/image_model.h"

namespace surf {

/// Moments of the directions v in which electrons move at a place, in cylinder coordinates about
/// the beam, each a path length per volume and primary (counts per nm^2): v_r, v_z, v_r^2, v_phi^2,
/// v_z^2, v_r v_z.
inline constexpr std::size_t diffusion_moments = 6;

struct DiffusionMatrixChannel {
  std::string name;
  /// [ring][height][moment], averages over a ring and one step of height about the height. Ring k
  /// reaches from k ring_nm to (k + 1) ring_nm; heights are lowest_nm, lowest_nm + height_step_nm
  /// ...
  std::vector<double> moments_per_nm2;
};

struct DiffusionMatrixParameters {
  double ring_nm = 1;                            ///< > 0
  double lowest_nm = 0;                          ///< relative to where the beam enters
  double height_step_nm = 1;                     ///< > 0
  int rings = 0;                                 ///< 1 to 4096
  int heights = 0;                               ///< 2 to 4096
  std::vector<DiffusionMatrixChannel> channels;  ///< 1 to 8
};

/// The diffusion matrix (Desai 1990, Czyzewski 1991; thesis, 2.2.2) on height fields: a channel is
/// the flux through all pixels' facets around, counted where it goes out, as if matter were
/// everywhere.
///
/// Where they tabulate the flux for a choice of orientations, here it follows for any from moments:
/// out of n goes 1/2 (<v n> + <|v n|>), with |c| taken as 3/16 + 15/16 c^2 (Legendre polynomials of
/// degree 0 and 2), which is exact where directions are spread up to degree 3 and never off by more
/// than 3/16. Moments are averaged over a pixel's column and smooth in height (quadratic
/// B-splines); a facet has its pixel's height and slope by central differences.
///
/// It knows of no electron that leaves and enters again, and counts one that crosses the surface
/// several times each time it goes out. The scope needs a pixel size, and the rings may reach
/// `most_diffusion_columns` of its pixels at most. Throws InvalidInput for parameters out of range.
std::shared_ptr<const ImageModel> make_diffusion_matrix(
    const ModelScope& scope, const DiffusionMatrixParameters& parameters);

inline constexpr int most_diffusion_columns = 40;

}  // namespace surf
