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

/// An image of a microscope and what a model gives for the same surface, pixel on pixel.
struct CalibrationImages {
  Grid<double> real;                  ///< E, grey levels or any unit that is linear in the signal
  std::vector<std::string> channels;  ///< names, 1 to 8: SE and BSE, or one of them
  ModelImages simulated;  ///< one per channel, counts per primary, of the size of `real`
  Mask used;              ///< 0: the pixel is left out; or empty: all count
  Grid<double> weights;   ///< 1 / variance of each pixel, up to a factor, >= 0; or empty: alike
};

struct CalibrationOptions {
  std::optional<double> offset;  ///< known beforehand, as of a blanked beam; else it is fitted
  /// Gains relative to the first channel's, where they are known: one per channel, the first 1. One
  /// gain is fitted then. Empty: all gains are free.
  std::vector<double> ratios;
  /// Pixels at or beyond these levels are saturated: they are left out and counted.
  double black = -std::numeric_limits<double>::infinity();
  double white = std::numeric_limits<double>::infinity();
  /// Above it, channels are called too alike, >= 1: what the model is off by, seen by the gains, is
  /// enlarged up to so many times. 30: Belsley, Kuh and Welsch 1980, 3.2. Two channels reach it
  /// where their correlation is 0.9978.
  double highest_condition = 30;
};

enum class CalibrationOutcome {
  trusted,   ///< none of what follows
  doubtful,  ///< a gain is below 0 or less than two standard errors from it, or condition_number >
             ///< highest_condition; `warnings` say which
  undetermined,  ///< the channels depend on each other to within rounding: infinitely many gains
                 ///< fit alike, and those given are the smallest (of channels scaled to the same
                 ///< spread)
};

/// E = sum of gain * channel + offset + residual (thesis, Equation 6-2).
struct Calibration {
  CalibrationOutcome outcome = CalibrationOutcome::trusted;
  std::vector<std::string> channels;
  std::vector<double> gains;  ///< one per channel, units of E per count per primary
  double offset = 0;          ///< units of E
  /// Of the gains in their order, then the offset; row-major, n + 1 rows. A fixed offset has 0.
  /// Infinite on the diagonal and 0 elsewhere if undetermined. It takes the residuals of pixels as
  /// independent: see `residual_correlation`.
  std::vector<double> covariance;
  /// Ratio of the largest to the smallest singular value of the channels as they are fitted: each
  /// less its mean (where the offset is fitted) and scaled to length 1. Infinite if undetermined.
  double condition_number = 1;
  double residual_rms = 0;          ///< sqrt(sum of weight r^2 / sum of weights), units of E
  double explained = 0;             ///< share of the variance of E that the fit explains, at most 1
  double residual_correlation = 0;  ///< of the residuals of neighbours along x
  std::int64_t pixels = 0;          ///< that count
  std::int64_t saturated = 0;       ///< left out for `black` and `white`
  std::vector<std::string> warnings;  ///< for people: what is wrong, what to do

  double gain_stderr(std::size_t channel) const;
  double offset_stderr() const;
};

/// Linear least squares. Pixels where E, a channel or the weight is not finite, or the weight is 0,
/// do not count. Throws InvalidInput for sizes or names that do not fit together, negative weights,
/// if fewer pixels count than numbers are fitted and one, or if a channel is 0 in all of them;
/// UsageError for options out of range.
Calibration calibrate(const CalibrationImages& images, const CalibrationOptions& options = {});

/// The fit as an image: sum of gain * channel + offset. Throws InvalidInput for other channels.
Grid<double> calibrated_image(const Calibration& calibration, const ModelImages& simulated);

/// A gain that varies slowly over the image (Davidson 1999; thesis, 6.7.1).
struct SlowGain {
  Grid<double> gain;         ///< F; 1 where it is not known
  Mask known;                ///< 0: nothing to divide by there, see `slow_gain`
  std::int64_t unknown = 0;  ///< pixels
};

/// F = mean of E / mean of the model's signal over the square of pixels whose centres are at most
/// `range_x_px`, `range_y_px` columns and rows away (>= 0), cut at the image's borders. Pixels that
/// are 0 in `used` (or empty) or not finite in one of the images play no part. Where none is left,
/// or the mean of the signal is less than 1e-3 of the image's mean absolute signal, F is not known.
/// A surface searched for with it is not told from one whose image is a multiple of its own
/// (thesis, 6.7.1): it is for comparing, not for descending. Throws InvalidInput for sizes that
/// differ, UsageError for a negative range.
SlowGain slow_gain(const Grid<double>& real, const Grid<double>& signal, int range_x_px,
                   int range_y_px, const Mask& used = {});

/// A filter bank with the gains and the offset folded into its coefficients (thesis, Equation 6-3):
/// one channel `name`, in units of E. Throws InvalidInput if the bank lacks a channel of the
/// calibration.
FilterBankParameters fold(const Calibration& calibration, const FilterBankParameters& bank,
                          const std::string& name = "signal");

}  // namespace surf
