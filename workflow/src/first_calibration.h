// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "surf/sem/calibration.h"
#include "surf/sem/sem_noise.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// Marks saturated pixels as invalid: pixels at the smallest or the largest value, if more than 0.1
/// % of the image share it, and more than three times as many as share the next value. Returns
/// their number.
std::int64_t leave_out_saturated(PlacedImage& image);

/// The initial gains, offset and noise of the reconstruction.
struct FirstCalibration {
  std::vector<double> gains;
  double offset = 0;
  std::optional<Calibration> fit;  ///< absent: the calibration was given
  SemNoise noise;
  std::string noise_from;
  bool tied = false;   ///< the channels cannot be told apart, so their gains are kept equal
  double overlap = 1;  ///< share of the SEM pixels that lie on the scan
  std::vector<std::string> warnings;
};

/// Fits the image that the model predicts from the eroded scan, mapped to the SEM image, to the
/// real image; weights follow from the noise. If a gain is below 0 or doubtful, one gain for all
/// channels is fitted instead. Without `eroded` the calibration must be given. Throws InvalidInput
/// if the images do not overlap, or if the real image has nothing in common with the simulated one.
FirstCalibration calibrate_first(const PlacedImage& sem, const HeightField* eroded,
                                 const ImageModel& model, const Affine& sem_to_afm,
                                 const std::optional<GivenCalibration>& given,
                                 const std::optional<SemNoise>& noise, int threads);

/// Repeats the calibration and the noise estimate with a surface in the SEM's frame that is closer
/// to the true one than the eroded scan. The noise is estimated from the residual of the image, so
/// that it holds at all grey levels and includes the model's error. Given values (`fix_gains`,
/// `fix_noise`) are kept. Returns whether anything changed by more than a tenth.
bool calibrate_again(const PlacedImage& sem, const HeightField& surface, const ImageModel& model,
                     bool fix_gains, bool fix_noise, int threads, FirstCalibration& first);

}  // namespace surf::workflow
