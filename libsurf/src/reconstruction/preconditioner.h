// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "objective.h"
#include "sparse_factor.h"
#include "surf/core/progress.h"

namespace surf::reconstruction {

/// A sparse approximation of the Gauss-Newton second derivative, which can be factorised. It
/// contains the prior, and the contacts as if the AFM's noise were white and its samples bilinear;
/// it leaves out the SEM. The prior alone spans eight orders of magnitude between flat parts and
/// long waves, which conjugate gradients cannot handle. The SEM's part is as large as the prior's
/// where the surface is curved; including it saved at most a tenth of the products.
class Preconditioner {
 public:
  /// Approximate side of a tile in samples. Small tiles are factorised faster, and solved in a
  /// processor's cache.
  static constexpr int usual_tile_px = 96;

  /// Tiles of about `tile_px` overlap and are factorised separately, so that the work is
  /// proportional to the area and all threads share it. 0: a single tile, which gives the inverse
  /// of the matrix up to rounding.
  Preconditioner(int tile_px, int threads, Precision precision = Precision::single_where_it_holds);
  ~Preconditioner();

  /// Factorises for the weights and contacts of this state. The first call also finds the order of
  /// elimination.
  void factor(const Objective& objective, const Unknowns& at, const Objective::State& state);

  /// Solves with all tiles. Where tiles overlap, solutions are blended: the roots of weights that
  /// add up to 1 are applied before and after each solution, so that the operator is symmetric.
  Step solve(const Step& residual) const;
  /// The same for several residuals at once, which reads the factors once for all of them.
  std::vector<Step> solve(const std::vector<Step>& residuals) const;

  /// Variances under the covariance that is the inverse of this matrix. Each sample's variance
  /// comes from `draws` draws within its tile.
  struct Variances {
    Grid<double> height_nm2;
    Grid<double> curvature_per_nm2;  ///< the mean of `CurvaturePrior::squared_curvature`
  };
  Variances variances(const CurvaturePrior& prior, int draws, std::uint64_t seed,
                      const Watch& watch) const;

  int tiles() const;
  int double_tiles() const;   ///< tiles whose factor is in double precision
  double error() const;       ///< the largest SparseFactor::error
  double flops() const;       ///< of all factors in single precision
  std::size_t bytes() const;  ///< of all factors

 private:
  struct Tile {
    Area area, own;      // with and without the overlap
    Grid<double> share;  // root of the weight of its solution, of the size of `area`
    // Solving uses its workspace; refining may replace it by one in double precision.
    mutable SparseFactor factor;
  };
  struct Blocks;  // blocks of map, mixture and tip

  void make_tiles(int width, int height);

  std::vector<Grid<double>> solve_heights(const std::vector<Step>& residuals) const;

  int tile_px_, threads_;
  Precision precision_;
  std::vector<Tile> tiles_;
  std::unique_ptr<Blocks> blocks_;
};

}  // namespace surf::reconstruction
