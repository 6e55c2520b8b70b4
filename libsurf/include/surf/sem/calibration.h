// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/sem/filter_bank.h"
#include "surf/sem/image_model.h"

namespace surf {

/// An image of a microscope and the images of a model for the same surface, pixel on pixel.
struct CalibrationImages {
  Grid<double> real;  ///< E, in grey levels or any unit that is linear in the signal
  std::vector<std::string> channels;  ///< names, 1 to 8: SE and BSE, or one of them
  ModelImages simulated;  ///< one per channel, counts per primary, of the size of `real`
  Mask used;              ///< 0: the pixel is left out; empty: all pixels count
  Grid<double> weights;   ///< 1 / variance up to a common factor, >= 0; empty: equal weights
};

struct CalibrationOptions {
  /// Known offset, for example from a blanked beam; else it is fitted.
  std::optional<double> offset;
  /// Gains relative to that of the first channel, if they are known: one per channel, the first 1.
  /// Then a single gain is fitted. Empty: all gains are free.
  std::vector<double> ratios;
  /// Pixels at or beyond these levels are saturated; they are left out and counted.
  double black = -std::numeric_limits<double>::infinity();
  double white = std::numeric_limits<double>::infinity();
  /// Condition number above which channels are too alike, >= 1: errors of the model are enlarged up
  /// to this factor in the gains. 30: Belsley, Kuh and Welsch 1980, 3.2. Two channels reach 30 if
  /// their correlation is 0.9978.
  double highest_condition = 30;
};

enum class CalibrationOutcome {
  trusted,  ///< neither doubtful nor undetermined
  /// A gain is more than two standard errors below 0, or every gain is within two standard errors
  /// of 0, or condition_number > highest_condition. `warnings` says which.
  doubtful,
  /// The channels are linearly dependent to within rounding, so infinitely many gains fit equally
  /// well. The smallest gains are given, for channels scaled to the same spread.
  undetermined,
};

/// E = sum of gain * channel + offset + residual (thesis, Equation 6-2).
struct Calibration {
  CalibrationOutcome outcome = CalibrationOutcome::trusted;
  std::vector<std::string> channels;
  std::vector<double> gains;  ///< one per channel, units of E per count per primary
  double offset = 0;          ///< units of E
  /// Covariance of the gains in their order and the offset; row-major, n + 1 rows. The entries of a
  /// fixed offset are 0. If undetermined, infinite on the diagonal and 0 elsewhere. It assumes that
  /// the residuals of pixels are independent: see `residual_correlation`.
  std::vector<double> covariance;
  /// Ratio of the largest to the smallest singular value of the fitted channels, each minus its
  /// mean (if the offset is fitted) and scaled to length 1. Infinite if undetermined.
  double condition_number = 1;
  double residual_rms = 0;          ///< sqrt(sum of weight r^2 / sum of weights), units of E
  double explained = 0;             ///< share of the variance of E that the fit explains, at most 1
  double residual_correlation = 0;  ///< of the residuals of neighbours along x
  std::int64_t pixels = 0;          ///< pixels that count
  std::int64_t saturated = 0;       ///< pixels that `black` and `white` exclude
  std::vector<std::string> warnings;  ///< for people: what is wrong, what to do

  double gain_stderr(std::size_t channel) const;
  double offset_stderr() const;
};

/// Fits gains and offset by linear least squares. A pixel does not count if its weight is 0, or if
/// E, a channel or the weight is not finite. Throws InvalidInput for sizes or names that do not fit
/// together, negative weights, no more pixels than fitted numbers, and a channel that is 0 in all
/// pixels that count; UsageError for options out of range.
Calibration calibrate(const CalibrationImages& images, const CalibrationOptions& options = {});

/// The fitted image: sum of gain * channel + offset. Throws InvalidInput for other channels.
Grid<double> calibrated_image(const Calibration& calibration, const ModelImages& simulated);

/// A gain that varies slowly over the image (Davidson 1999; thesis, 6.7.1).
struct SlowGain {
  Grid<double> gain;         ///< F; 1 where it is not known
  Mask known;                ///< 0: the gain is not known, see `slow_gain`
  std::int64_t unknown = 0;  ///< pixels without known gain
};

/// F = mean of E / mean of the model's signal, over the rectangle of pixels whose centres are at
/// most `range_x_px` columns and `range_y_px` rows away (>= 0), cut at the image's borders. Pixels
/// that are 0 in `used` (empty: all count) or not finite in one of the images do not count. F is
/// unknown if no pixel is left, or if the mean of the signal is less than 1e-3 of the image's mean
/// absolute signal. With F, a surface cannot be distinguished from another one whose image is a
/// multiple (thesis, 6.7.1): use it for comparisons, not in an objective. Throws InvalidInput for
/// sizes that differ, UsageError for a negative range.
SlowGain slow_gain(const Grid<double>& real, const Grid<double>& signal, int range_x_px,
                   int range_y_px, const Mask& used = {});

/// Folds the gains and the offset into the coefficients of a filter bank (thesis, Equation 6-3).
/// The result has one channel `name`, in units of E. Throws InvalidInput if the bank lacks a
/// channel of the calibration.
FilterBankParameters fold(const Calibration& calibration, const FilterBankParameters& bank,
                          const std::string& name = "signal");

}  // namespace surf
