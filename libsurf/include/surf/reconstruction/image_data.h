// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "surf/afm/background.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/placed_image.h"
#include "surf/sem/film_model.h"
#include "surf/sem/image_model.h"
#include "surf/sem/sem_noise.h"

namespace surf {

/// A levelled scan and its imaging model: image = dilation of the surface by the tip + noise.
struct AfmData {
  HeightField image;
  Tip tip;  ///< with the pitch of the image
  AfmNoise noise;
  /// The dilation is computed with this many samples per pitch (thesis, appendix C.3), in [1, 8].
  int upsample = 3;
  /// Standard errors of the slopes that were taken off the scan, nm per nm: the surface may be
  /// tilted by as much.
  SlopeDoubt level_doubt = {};
};

/// What the model of an SEM image may be off by beside its noise: other physics, another detector,
/// contamination, gains that drift. A Gaussian field of mean 0.
struct SemDiscrepancy {
  Grid<double> deviation;     ///< its standard deviation at each pixel, in the image's unit, >= 0
  double correlation_px = 4;  ///< its correlation length, 1 to 1000; rounded to whole pixels
};

/// What a displacement of lines along x by `deviation_px` changes in the image, pixel by pixel: its
/// slope over 1.5 pixels. Throws InvalidInput.
Grid<double> line_jitter(const PlacedImage& image, double deviation_px);

/// A discrepancy that grows with how far a pixel stands out of the image: `share` of its distance
/// from the median grey level, over some pixels, and half of that as a gain that drifts over the
/// image. Throws InvalidInput.
std::vector<SemDiscrepancy> usual_discrepancy(const PlacedImage& image, double share);

/// Root mean square of an image about its mean, over some pixels, so that noise hardly counts.
/// Throws InvalidInput.
double contrast_of(const PlacedImage& image);

/// An SEM image and its imaging model: image = sum of gain * channel of the model + offset + noise.
struct SemData {
  PlacedImage image;  ///< with square pixels of the model's size
  std::shared_ptr<const ImageModel> model;
  std::vector<double> gains;  ///< one per channel of the model; 0 leaves a channel out
  double offset = 0;
  SemNoise noise;
  Affine sem_to_afm;
  /// Independent of each other, in the order of their correlation lengths; none: the model is
  /// right.
  std::vector<SemDiscrepancy> discrepancy = {};
  /// The discrepancy also follows what the surface is like around each pixel, as far as the image
  /// says how: standard deviation, in the image's unit, of what functions of slopes and brightness
  /// may add together. Only with a scan and a discrepancy, and only for Gauss-Newton. 0: it does
  /// not.
  double guided_deviation = 0;
  /// What rows that are displaced along themselves by one standard deviation change in the image
  /// (see `line_jitter`). Each row's displacement, in deviations, is standard normal and eliminated
  /// with the discrepancy. Empty: rows are where they belong.
  Grid<double> row_jitter = {};
  /// A film on the specimen, whose thickness is fitted. Absent: there is none.
  std::optional<FilmEffect> film = {};
};

/// Statistics of an image's whitened residuals: standard normal and white if everything is right.
struct ResidualReport {
  double mean = 0, deviation = 1;
  double along = 0, across = 0;  ///< correlation of neighbours along and across rows
  std::int64_t pixels = 0;
  bool like_noise = true;
};

}  // namespace surf
