// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "objective.h"
#include "sparse_factor.h"
#include "surf/core/progress.h"

namespace surf::reconstruction {

/// A matrix like the Gauss-Newton second derivative, but sparse, so that it can be factored: the
/// prior's part and the contacts' as if the AFM's noise were white and its samples bilinear; the
/// SEM's part is left out. The prior spans eight orders of magnitude between a plain and a long
/// wave, which is what conjugate gradients cannot bear; what the SEM adds is of the prior's size
/// where the surface bends, and saved a tenth of the products at most.
class Preconditioner {
 public:
  /// About how many samples a tile is wide and high: small ones are factored sooner, and solved in
  /// a processor's cache.
  static constexpr int usual_tile_px = 96;

  /// Tiles of about `tile_px` overlap and are factored apart, so that the work grows with the area
  /// alone and all threads share it. 0: one tile, the matrix's inverse but for rounding.
  Preconditioner(int tile_px, int threads);
  ~Preconditioner();

  /// For weights and contacts of this state. The first call finds the order of elimination.
  void factor(const Objective& objective, const Unknowns& at, const Objective::State& state);

  /// Where tiles overlap their solutions are blended, by the roots of weights that add up to 1
  /// before and after, so that the whole is symmetric.
  Step solve(const Step& residual) const;

  /// Variances of what has its inverse as covariance, each sample's from `draws` draws within its
  /// tile.
  struct Variances {
    Grid<double> height_nm2;
    Grid<double> curvature_per_nm2;  ///< the mean of `CurvaturePrior::squared_curvature`
  };
  Variances variances(const CurvaturePrior& prior, int draws, std::uint64_t seed,
                      const Watch& watch) const;

 private:
  struct Tile {
    Area area, own;      // with and without what it shares
    Grid<double> share;  // root of the weight that its solution has, of its size
    SparseFactor factor;
  };
  struct Blocks;  // of the few other unknowns

  void make_tiles(int width, int height);

  int tile_px_, threads_;
  std::vector<Tile> tiles_;
  std::unique_ptr<Blocks> blocks_;
};

}  // namespace surf::reconstruction
