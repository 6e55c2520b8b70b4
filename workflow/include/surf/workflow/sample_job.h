// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "surf/afm/noise.h"
#include "surf/core/affine.h"
#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// How the two images of a sample surface are taken. The AFM's frame begins at its image's
/// lower-left sample, the SEM's at its lower-left pixel.
struct SampleScene {
  std::string name;  ///< of its surface (surf/reconstruction/sample_surfaces.h)
  std::string what;  ///< of it: one line for people

  AffineParts sem_to_afm;  ///< its shift follows from the margins
  double margin_left_nm = 300,
         margin_right_nm = 300;  ///< of the scan around the SEM image, in the AFM's frame
  double margin_bottom_nm = 300, margin_top_nm = 300;
  double afm_pitch_nm = 20;
  double tip_radius_nm = 70, tip_half_angle_deg = 28;  ///< a cone that ends in a sphere
  AfmNoise afm_noise{0.825, 0.201};                    ///< the thesis's (section 8.1.1)
  double tilt_x_deg = 0, tilt_y_deg = 0;               ///< of the whole scan
  double afm_offset_nm = 0;                            ///< of its heights

  double sem_pixel_nm = 10;
  std::string material = "Si";
  double energy_ev = 1000, spot_nm = 3;
  double se_gain = 900, bse_gain = 300,
         offset = 120;  ///< signal = these times yields, and the offset
};

/// The five that there are, one for each sample surface.
const std::vector<SampleScene>& sample_scenes();

struct SampleJob {
  std::string name;
  std::filesystem::path folder;   ///< made if it is not there
  int width = 456, height = 172;  ///< of the SEM image, 16 to 4096: the middle of the view
  std::int64_t electrons = 200;   ///< primaries per SEM pixel, 1 to 2^31
  /// In the library that the SEM image is replayed from, at least 2048: its own chance error is
  /// common to all pixels, 0.7 % with so many.
  std::size_t cascades = 40960;
  std::uint64_t seed = 1;        ///< of all chance
  int threads = 0;               ///< 0: one per hardware thread. Does not change the result
  std::filesystem::path cache;   ///< where libraries of cascades are kept; empty: nowhere
  CheckpointOptions checkpoint;  ///< of the SEM image; without a file of its own beside sem.tif
};

/// All but `checkpoint` and `cascades`.
void describe(ParameterVisitor& visit, SampleJob& job);

struct SampleSummary {
  bool complete = true;              ///< false when cancelled: no image is written
  std::filesystem::path checkpoint;  ///< where a cancelled job goes on from; empty: nothing is kept
  Affine sem_to_afm;
  int afm_width = 0, afm_height = 0;
  double seconds = 0;  ///< of the simulation of the SEM image
  std::vector<std::filesystem::path> written;
};

/// Makes two images of a sample surface and says what is true (docs/methods/sample_scenes.md):
///   afm.gsf        the scan: the surface on a grid three times as fine, dilated by the tip, every
///   third sample;
///                  correlated noise; a tilt
///   sem.tif        the SEM image, by Monte Carlo: channel "signal", 32-bit floats
///   truth.gsf      the surface's heights on the SEM image's pixels, in its frame
///   truth_tip.gsf  the tip's structuring function at the scan's pitch
///   truth_sem.exr  what the simulation gave: SE, BSE and their standard errors, per primary
///   truth.json     the map, the gains, the noise and all other parameters
/// Only the names with "truth" tell what a reconstruction has to find out.
/// Progress is in cascades, then primaries. A job that is cancelled, or whose files cannot be
/// written, keeps a checkpoint: the same job goes on from there, to the same bytes. Throws
/// UsageError for an unknown name or options out of range, FileError.
SampleSummary run(const SampleJob& job, const Reporter& reporter = {});

}  // namespace surf::workflow
