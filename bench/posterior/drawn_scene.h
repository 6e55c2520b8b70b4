// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "reconstruction/initial_surface.h"
#include "reconstruction/objective.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::bench {

/// What a scene is drawn with; lengths in nm unless said otherwise.
struct SceneOptions {
  int width = 64, height = 48;  ///< of the SEM image, pixels of 10 nm
  int tip_half_px = 10;         ///< half of the tip's side, samples of 10 nm
  double discrepancy_share = 0.05;
  bool features = true;  ///< false: one mesa in the middle, for very small images
};

/// A block with walls of the shape of the normal distribution function.
struct Block {
  Point2 middle;
  double half_u_nm = 0, half_v_nm = 0;  ///< half sides; v infinite for a line
  double turn_rad = 0;                  ///< of u against x
  double height_nm = 0, wall_nm = 1;    ///< `wall_nm`: standard deviation of the wall's slope

  Point2 within(Point2 p) const;  ///< (u, v)
  double height_at(Point2 p) const;
};

/// A drawn surface, both images of it, and what the reconstruction starts from.
struct DrawnScene {
  AfmData afm;         ///< with the given tip, which is not the true one
  SemData sem;         ///< with given map, gains and offset
  HeightField truth;   ///< on the SEM's pixels
  HeightField ground;  ///< the same with more around
  Affine true_map;
  reconstruction::TipChange true_tip{};
  double true_gain_factor = 1, true_offset = 0;
  Block plateau, line;
};

/// The scene of a seed. The generator is described in bench_posterior.cpp.
DrawnScene draw_scene(const std::shared_ptr<const ImageModel>& model, std::uint64_t seed,
                      const SceneOptions& options = {});

/// A reconstruction, and the objective at its end, which holds all of its unknowns.
struct Fitted {
  Reconstruction result;
  reconstruction::Objective objective;
  reconstruction::Unknowns at;
  int margin_px = 0;  ///< samples of the surface beyond each side of the SEM image

  /// The part within the SEM image.
  template <class T>
  Grid<T> inner(const Grid<T>& grid) const {
    return reconstruction::cut_out(grid, margin_px, margin_px, grid.width() - 2 * margin_px,
                                   grid.height() - 2 * margin_px);
  }
};

/// Where the last scale of a fit begins: at the end of the one before, or at the truth.
enum class Start { given, truth };

/// Fits with all unknowns free. `margin_px`, if not negative, is the margin of the objective, which
/// has to be minimised again then.
Fitted fit_scene(const DrawnScene& scene, Start start, bool uncertainty, int margin_px = -1);

}  // namespace surf::bench
