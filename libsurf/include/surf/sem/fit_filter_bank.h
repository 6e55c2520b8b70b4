// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/sem/filter_bank.h"
#include "surf/sem/trained_model.h"
#include "surf/sem/training_image.h"

namespace surf {

struct FilterBankFitOptions {
  std::vector<FacetScale> scales = thesis_scales();
  bool multi_resolution = false;  ///< see FilterBankParameters

  /// Principal components of the bank's outputs are left out if their eigenvalue of the correlation
  /// matrix is below this, >= 0 (thesis, 6.6: 0.1). Fewer components are less accurate on the
  /// training images and safer on all others; 0 keeps all.
  double eigenvalue_cutoff = 0.1;

  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};

struct FilterBankFit {
  FilterBankParameters parameters;
  std::vector<double> eigenvalues;  ///< of the outputs' correlation matrix, the largest first
  int components = 0;               ///< number of components kept
  /// Condition number of the least-squares matrix, whose columns are 1 and the components of the
  /// standardised outputs: about the root of the ratio of the largest to the smallest kept
  /// eigenvalue. The largest number over the channels.
  double condition_number = 0;
  std::vector<ModelResidual> residuals;  ///< on the training images, one per channel
  std::vector<std::string> warnings;     ///< sentences with reasons not to trust the model
};

/// Trains a filter bank on images (thesis, 6.6). It computes principal components of the bank's
/// outputs at all used pixels, fits each channel by weighted linear least squares, and converts the
/// result to coefficients of slopes and curvatures. The weight of a pixel is 1 / (standard error^2
/// + misfit^2); the misfit is the part of the residuals beyond the noise in a first fit with equal
/// weights. Weights by the noise alone would spend the model's freedom on dark pixels, whose noise
/// is smallest, at the expense of other pixels (docs/explanation/filter_bank.md). Without standard
/// errors all pixels have the same weight. Images are processed block by block; the memory grows
/// with their size only by a triangle of 33 x 33 numbers per 5000 pixels or so. Throws InvalidInput
/// for images that cannot be used or names that do not fit their channels, UsageError for a cut-off
/// that is not a number >= 0.
FilterBankFit fit_filter_bank(const std::vector<TrainingImage>& images,
                              const std::vector<std::string>& channels,
                              const FilterBankFitOptions& options = {});

/// The errors of a model on images, which may or may not be its training images; one entry per
/// channel. Pixels whose signal is not above 0 do not count in the relative error. `rms` is 0 if
/// the noise explains the whole difference.
std::vector<ModelResidual> residuals_of(const ImageModel& model,
                                        const std::vector<TrainingImage>& images, int threads = 0);

/// Combines all channels of a bank into the one channel "signal" = offset + sum of gain times
/// channel, for a microscope's detector that detects all of them (thesis, Equation 6-3). Throws
/// InvalidInput unless there is a finite gain for each channel.
FilterBankParameters fold_calibration(const FilterBankParameters& parameters,
                                      const std::vector<double>& gains, double offset);

}  // namespace surf
