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

/// Marks pixels at the least or the largest value as not valid where so many share it that the
/// detector must have been at its limit: over 0.1 % of the image, and over three times as many as
/// at the next value. Returns how many were.
std::int64_t leave_out_saturated(PlacedImage& image);

/// Gains, offset and noise that the reconstruction begins with.
struct FirstCalibration {
  std::vector<double> gains;
  double offset = 0;
  std::optional<Calibration> fit;  ///< absent: given
  SemNoise noise;
  std::string noise_from;
  bool tied = false;   ///< the channels cannot be told apart: their gains are kept equal
  double overlap = 1;  ///< share of the SEM pixels that lie on the scan
  std::vector<std::string> warnings;
};

/// The image that the model predicts of the eroded scan where the map lays it, against the real
/// one; weights from the noise. Gains that come out below 0 or doubtful are fitted again as one for
/// all channels. Without `eroded` the calibration must be given. Throws InvalidInput where the
/// images do not overlap, or the real one has nothing of the simulated one.
FirstCalibration calibrate_first(const PlacedImage& sem, const HeightField* eroded,
                                 const ImageModel& model, const Affine& sem_to_afm,
                                 const std::optional<GivenCalibration>& given,
                                 const std::optional<SemNoise>& noise, int threads);

/// Both again, from a surface in the SEM's frame that is nearer to the true one than the eroded
/// scan: the noise from what the surface leaves of the image, so that it holds at all grey levels
/// and what the model is off by counts. What is given (`fix_gains`, `fix_noise`) stays. Returns
/// whether anything changed by more than a tenth.
bool calibrate_again(const PlacedImage& sem, const HeightField& surface, const ImageModel& model,
                     bool fix_gains, bool fix_noise, int threads, FirstCalibration& first);

}  // namespace surf::workflow
