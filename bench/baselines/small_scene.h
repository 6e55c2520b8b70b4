// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "global_optimisers.h"
#include "reconstruction/objective.h"
#include "sample_truth.h"

namespace surf::bench {

/// A few pixels of a sample, and the reconstruction's objective of both images there. Heights alone
/// are unknown: map, tip, gains, offset and noise are the true ones, and the prior is that of the
/// last scale.
struct SmallScene {
  reconstruction::Objective objective;
  reconstruction::Unknowns start;  ///< the eroded scan
  Grid<double> truth_nm;           ///< of the SEM image's pixels
  int margin = 0;                  ///< samples of the surface around them
  double most_off_nm = 0;          ///< of the start's heights there

  /// Root mean square error of heights, nm.
  double off_nm(const std::vector<double>& z_nm) const;
  Grid<double> on_pixels(const std::vector<double>& z_nm) const;
};

/// The square of `side` pixels where the eroded scan is off most. The sample has a model, gains and
/// noise.
SmallScene small_scene(const workflow::SampleTruth& sample, int side);

/// A box of numbers, and the heights of the surface's samples that they stand for.
struct HeightBox {
  BoxProblem problem;
  std::function<std::vector<double>(const std::vector<double>&)> heights_nm;
};

/// Heights may go from the start by half as much again as any of them is off. `spacing` 0: the
/// numbers are the heights; else they are coefficients of cubic B-splines, as many samples apart,
/// that are added to the start.
HeightBox box_of(const SmallScene& scene, int spacing = 0);

}  // namespace surf::bench
