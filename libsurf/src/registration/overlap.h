// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/corners.h"
#include "registration/smooth_image.h"

namespace surf {

/// One blur of both images: the SEM's at some of its pixels, the AFM's everywhere.
struct BlurLevel {
  BlurLevel(const PlacedImage& sem, const PlacedImage& afm, const CornerFrame& frame,
            double blur_px);

  struct Sample {
    Shares shares;
    double value;
    int column, row;
  };

  double blur_px;
  int stride;  ///< pixels between samples: as many as the blur leaves to tell apart
  std::vector<Sample> samples;    ///< valid ones, row by row
  double sem_step_x, sem_step_y;  ///< pixels of each axis in SEM pixels of the frame
  SmoothImage sem, afm;
};

/// The samples of a level whose places under a map the AFM's image holds, as indices.
std::vector<std::size_t> overlap_of(const BlurLevel& level, const Corners& corners);

Moments moments_of(const BlurLevel& level, const std::vector<std::size_t>& overlap);

/// Share of the smaller of both images that lies in the other.
double overlap_share(const BlurLevel& level, const Corners& corners, std::size_t overlapping);

/// Correlation where both images are, and how much that tells.
struct Agreement {
  double correlation = 0;
  std::size_t samples = 0;

  /// Log-likelihood ratio of a line between the intensities against none; 0 for falling lines.
  /// Larger with more samples, so that a chance likeness of a corner does not beat a good fit of
  /// everything.
  double evidence() const;
};
Agreement agreement_of(const BlurLevel& level, const Corners& corners);

}  // namespace surf
