// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/progress.h"

namespace surf {

/// What some primaries of each pixel gave at one detector.
struct CountHalf {
  Grid<double> primaries;  ///< their number, >= 0
  Grid<double> sum;        ///< of the electrons that each of them sent to the detector
  Grid<double> squares;    ///< sum of the squares of these numbers
};

/// Counts of one detector. The two halves are of different primaries.
using CountImage = std::array<CountHalf, 2>;

/// Something known at each pixel that costs no electrons: a fast model's image, a slope. An
/// estimate follows it as far as the counts around a pixel agree.
struct Guide {
  std::string name;
  Grid<double> values;    ///< finite
  bool predicts = false;  ///< a prediction of the yield itself: it may also guide alone
  /// Of a guide that is made of the same primaries' counts, as another detector's image: `values`
  /// are of the second half and guide the first, these are of the first and guide the second, so
  /// that no count guides itself. Empty: `values` guide both.
  Grid<double> of_first = {};
};

struct GuidedOptions {
  /// Pixels of different numbers do not help each other: materials, sides of an edge. Below 0:
  /// nothing is to be seen there. Empty: all pixels are alike.
  Grid<int> region;
  /// Cascades of the library that the primaries were drawn from, which all pixels share; 0: there
  /// is none.
  double library_cascades = 0;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// The yield of each pixel, estimated from its counts and those around it.
struct GuidedImage {
  Grid<double> mean;   ///< counts per primary
  Grid<double> error;  ///< root mean square error of `mean`: noise, bias, and the library's share
  /// Radius of the disc of equal weights whose mean would be as noisy, in pixels: how far a pixel
  /// shares its error with its neighbours.
  Grid<double> radius_px;
  double noise_scale = 1;  ///< variance between the halves over that of the primaries' scatter
  std::array<Grid<double>, 2> halves;  ///< the same as `mean` by each half of the primaries
};

/// Estimates yields by local linear regression of the counts on guides. Windows of several widths
/// with and without guides, and the plain counts, are combined around each pixel with the weights
/// (>= 0, sum 1) that make Stein's unbiased estimate of the relative risk least: so where guides or
/// neighbours lead astray, the plain counts remain. Regression of Monte Carlo images on features is
/// of Bitterli et al. 2016 (doi:10.1111/cgf.12954), choosing windows by Stein's risk of Li, Wu and
/// Chuang 2012 (doi:10.1145/2366145.2366213), averaging of models by risk of Hansen 2007
/// (doi:10.1111/j.1468-0262.2007.00785.x).
///
/// The variance of counts is a function of the fitted mean, a m + b m^2, never of a pixel's own
/// count. Results depend on neither threads nor the order of pixels. Throws InvalidInput for sizes
/// that differ and values that are not finite, Interrupted.
GuidedImage estimate_guided(const CountImage& counts, const std::vector<Guide>& guides,
                            const GuidedOptions& options = {});

/// Weighted mean of `values` in a Gaussian window around each pixel; 0 where no weight is near.
Grid<double> mean_around(const Grid<double>& values, const Grid<double>& weights, double sigma_px);

}  // namespace surf
