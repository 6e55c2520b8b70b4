// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/smooth_image.h"
#include "registration/three_point_map.h"

namespace surf {

/// Both images at one blur: the SEM's at some of its pixels, the AFM's everywhere.
struct BlurLevel {
  BlurLevel(const PlacedImage& sem, const PlacedImage& afm, const ThreePointFrame& frame,
            double blur_px);

  struct Sample {
    Shares shares;
    double value;
    int column, row;
  };

  double blur_px;
  int stride;  ///< pixels between samples: as many as the blur makes indistinguishable
  std::vector<Sample> samples;    ///< valid ones, row by row
  double sem_step_x, sem_step_y;  ///< pixel size along each axis, in SEM pixels of the frame
  SmoothImage sem, afm;
};

/// The indices of the samples of a level that a map places inside the AFM's image.
std::vector<std::size_t> overlap_of(const BlurLevel& level, const ThreePointMap& corners);

Moments moments_of(const BlurLevel& level, const std::vector<std::size_t>& overlap);

/// The share of the smaller image that lies in the other.
double overlap_share(const BlurLevel& level, const ThreePointMap& corners, std::size_t overlapping);

/// The correlation in the overlap, and its significance.
struct Agreement {
  double correlation = 0;
  std::size_t samples = 0;

  /// Log-likelihood ratio of a linear relation of the intensities against none; 0 for falling
  /// lines. It grows with the number of samples, so that a chance agreement in a corner does not
  /// beat a good fit of the whole image.
  double evidence() const;
};
Agreement agreement_of(const BlurLevel& level, const ThreePointMap& corners);

}  // namespace surf
