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

  /// Principal components of the bank's outputs whose eigenvalue of the correlation matrix is below
  /// this are left out, >= 0 (thesis, 6.6: 0.1). Fewer components are less accurate on what was
  /// trained on and safer on anything else; 0 keeps all.
  double eigenvalue_cutoff = 0.1;

  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};

struct FilterBankFit {
  FilterBankParameters parameters;
  std::vector<double> eigenvalues;  ///< of the outputs' correlation matrix, the largest first
  int components = 0;               ///< kept
  /// Of the least squares' matrix, its columns 1 and the components of outputs in units of their
  /// deviation: about the root of the largest eigenvalue over the smallest one kept. Of the channel
  /// where it is largest.
  double condition_number = 0;
  std::vector<ModelResidual> residuals;  ///< on the training images, one for each channel
  std::vector<std::string> warnings;     ///< sentences: why the model may not be trusted
};

/// Learns a filter bank from images (thesis, 6.6): principal components of its outputs at all used
/// pixels, weighted linear least squares of each channel, and the coefficients folded back to
/// slopes and curvatures. A pixel weighs 1 / (standard error^2 + misfit^2), where the misfit is
/// what a first fit with all weights alike leaves beyond the noise: weights by the noise alone
/// would spend the model's freedom on dark pixels, whose noise is least, and it would be worse on
/// others (docs/methods/filter_bank.md). Without standard errors all pixels weigh alike. Images are
/// gone through block by block; nothing grows with their size but a triangle of 33 x 33 numbers per
/// 5000 pixels or so. Throws InvalidInput for images that cannot be used or names that do not fit
/// their channels, UsageError for a cut-off that is not a number >= 0.
FilterBankFit fit_filter_bank(const std::vector<TrainingImage>& images,
                              const std::vector<std::string>& channels,
                              const FilterBankFitOptions& options = {});

/// How far a model is off on images that it may or may not have seen, one entry for each channel.
/// Pixels whose signal is not above 0 do not count in the relative error. Where the noise explains
/// all of the difference, and chance a little more, `rms` is 0.
std::vector<ModelResidual> residuals_of(const ImageModel& model,
                                        const std::vector<TrainingImage>& images, int threads = 0);

/// A bank with the one channel "signal" = offset + sum of gain times channel: a microscope's
/// detector that sees all of them (thesis, Equation 6-3). InvalidInput unless there is a finite
/// gain for each channel.
FilterBankParameters fold_calibration(const FilterBankParameters& parameters,
                                      const std::vector<double>& gains, double offset);

}  // namespace surf
