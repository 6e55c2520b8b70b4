// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surf/afm/noise.h"
#include "surf/core/affine.h"
#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/mc/physics/physics.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// How the two images of a sample surface are taken. The AFM's frame begins at the lower-left
/// sample of its image, the SEM's frame at its lower-left pixel.
struct SampleScene {
  std::string name;  ///< name of its surface (surf/reconstruction/sample_surfaces.h)
  std::string what;  ///< the surface in one line

  AffineParts sem_to_afm;  ///< the shift follows from the margins
  /// Margins of the scan around the SEM image, in the AFM's frame.
  double margin_left_nm = 300, margin_right_nm = 300;
  double margin_bottom_nm = 300, margin_top_nm = 300;
  double afm_pitch_nm = 20;
  double tip_radius_nm = 70, tip_half_angle_deg = 28;  ///< a cone that ends in a sphere
  AfmNoise afm_noise{0.825, 0.201};                    ///< the noise of the thesis (section 8.1.1)
  double tilt_x_deg = 0, tilt_y_deg = 0;               ///< tilt of the whole scan
  double afm_offset_nm = 0;                            ///< offset of the scan's heights

  double sem_pixel_nm = 10;
  std::string material = "Si";
  double energy_ev = 1000, spot_nm = 3;
  /// Signal = se_gain times SE yield + bse_gain times BSE yield + offset.
  double se_gain = 900, bse_gain = 300, offset = 120;
};

/// The five scenes, one for each sample surface.
const std::vector<SampleScene>& sample_scenes();

struct SampleJob {
  std::string name;
  std::filesystem::path folder;   ///< created if it is missing
  int width = 456, height = 172;  ///< of the SEM image, 16 to 4096; it shows the middle of the view
  std::int64_t electrons = 200;   ///< primaries per SEM pixel, 1 to 2^31
  /// Cascades in the library that the SEM image is replayed from, at least 2048. The library's
  /// chance error is common to all pixels: 0.7 % with 40960 cascades.
  std::size_t cascades = 40960;
  std::uint64_t seed = 1;  ///< seed of all random numbers
  /// What a reconstruction may not know: another physics than its model's; a tip that leans to one
  /// side, so that its half angle differs by as much on two sides and less between; a gain that
  /// drifts by this share over the image, as charging makes it.
  mc::Physics physics;
  double tip_lean_deg = 0, tip_azimuth_deg = 0;
  double gain_drift = 0;
  /// Nor these: another spot than its model's (absent: the scene's), and a detector that sees some
  /// of the secondaries only (as `parse_detectors` reads it; empty: all of them).
  std::optional<double> spot_nm;
  std::string detector;
  /// Nor these: rows of the scan that are displaced as a parabola along its slow axis, by this many
  /// pixels of the SEM image more at its ends than in the middle; and rows of the SEM image that
  /// are displaced along themselves by normal numbers of this deviation, in pixels.
  double scan_drift_px = 0, line_jitter_px = 0;
  /// Nor this: a film of this material and thickness, everywhere, under the true surface.
  std::string film;
  double film_nm = 2;
  int threads = 0;               ///< 0: one per hardware thread. Does not change the result
  std::filesystem::path cache;   ///< where libraries of cascades are stored; empty: nowhere
  CheckpointOptions checkpoint;  ///< for the SEM image; by default the file is beside sem.tif
};

/// All parameters except `checkpoint` and `cascades`.
void describe(ParameterVisitor& visit, SampleJob& job);

struct SampleSummary {
  bool complete = true;              ///< false if cancelled: no image is written
  std::filesystem::path checkpoint;  ///< checkpoint of a cancelled job; empty: there is none
  Affine sem_to_afm;
  int afm_width = 0, afm_height = 0;
  double seconds = 0;  ///< time of the SEM simulation
  std::vector<std::filesystem::path> written;
};

/// Makes two images of a sample surface and records the truth (docs/how-to/sample_scenes.md):
///   afm.gsf        the scan: the surface on a grid three times as fine, dilated by the tip, every
///                  third sample; correlated noise; a tilt
///   sem.tif        the SEM image, by Monte Carlo: channel "signal", 32-bit floats
///   truth.gsf      the surface's heights at the SEM image's pixels, in its frame
///   truth_tip.gsf  the tip's structuring function at the scan's pitch
///   truth_sem.exr  the result of the simulation: SE, BSE and their standard errors, per primary
///   truth.json     the map, the gains, the noise and all other parameters
/// Only the files named "truth" hold what a reconstruction has to find out.
/// Progress is in cascades, then primaries. A job that is cancelled, or whose files cannot be
/// written, keeps a checkpoint: the same job continues from it to the same bytes. Throws UsageError
/// for an unknown name or options out of range, FileError.
SampleSummary run(const SampleJob& job, const Reporter& reporter = {});

}  // namespace surf::workflow
