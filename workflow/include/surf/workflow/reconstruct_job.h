// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surf/reconstruction/reconstruct.h"
#include "surf/reconstruction/tilt_by_sem.h"
#include "surf/sem/calibration.h"
#include "surf/workflow/register_job.h"
#include "surf/workflow/view_settings.h"

namespace surf::workflow {

/// Known gains and offset.
struct GivenCalibration {
  std::vector<double> gains;  ///< one gain per channel of the model
  double offset = 0;
};

/// What is known of further SEM images beforehand.
struct KnownViews {
  std::vector<std::filesystem::path> models;  ///< as lists of ViewSettings; none: the first one's
  // One for each further image; none: found.
  std::vector<std::vector<double>> gains;  ///< of each channel of the model, then the offset
  std::vector<SemNoise> noises;
  std::vector<Point2> places_nm;  ///< shift of each image's frame in the plane that it sees
};

/// Reconstructs one surface from an AFM scan and an SEM image, or from one of them: the chain of
/// the thesis's figure 1-3.
struct ReconstructJob {
  std::optional<AfmInput> afm;
  std::optional<SemInput> sem;
  std::vector<SemInput> views;  ///< further SEM images of the same place, from other sides
  ViewSettings view_settings;
  KnownViews known_views;
  ModelRequest model;
  PoseOptions pose;
  /// Required without a scan; absent: fitted with the scan.
  std::optional<GivenCalibration> calibration;
  std::optional<SemNoise> sem_noise;  ///< absent: estimated
  /// What the model of SEM images may be off by, as a share of the image's contrast: see
  /// `usual_discrepancy`. 0: it is right.
  double model_error = 0.05;
  /// Standard deviation of displacements of the SEM image's rows along themselves, in pixels.
  double line_jitter_px = 0;
  /// Material of a film on the specimen, whose thickness is fitted in place of gains and offset,
  /// which must be given: a built-in material or one from these files. Empty: there is no film.
  std::string film;
  std::vector<std::string> material_files;
  /// Rounds in which Monte Carlo images of the surface correct the model, and their electrons per
  /// pixel. Models of other signals than SE and BSE cannot be corrected.
  int corrections = 2;
  std::int64_t correction_electrons = 32;
  /// Slopes that are added to the levelled scan; absent: found with the SEM image.
  std::optional<SemTilt> tilt;
  int upsample = 3;  ///< upsampling of the scan, see AfmData
  /// Fit the tip together with the surface; absent: if the tip was found blindly.
  std::optional<bool> refine_tip;
  /// its threads are used for all steps; `refine_tip` above replaces its own
  ReconstructionOptions options;
  /// True surface to compare with, in the SEM's frame, or in the scan's frame without an SEM image.
  std::optional<HeightField> truth;
  std::filesystem::path truth_file;
  /// Output folder, created if it is missing. Empty: no files are written.
  std::filesystem::path folder;
  std::string command_line;  ///< the command line as given, for the record
  bool picture = true;       ///< write panel.png, which needs Python with Matplotlib
};
/// The parameters of the inputs that are present, of the options, and of the output.
void describe(ParameterVisitor& visit, ReconstructJob& job);

/// How a part of a surface agrees with the truth.
struct RegionReport {
  /// "flat": no slope of 6 degrees within 3 pixels; "wall": steeper than 30 degrees; "foot": beside
  /// a wall; "untouched": the tip did not touch it; "edge": the lateral place of walls in the
  /// middle of their height, where the numbers below are of places along rows and columns. The true
  /// surface says what is what.
  std::string name;
  std::int64_t pixels = 0;
  double rms_nm = 0, stated_nm = 0;  ///< error, and posterior standard deviation
  double coverage_1 = 0, coverage_2 = 0, in_interval = 0;  ///< as in TruthReport
};

/// The difference between a surface and the true one. The median difference is taken off, because a
/// scan does not know where 0 is.
struct TruthReport {
  double rms_nm = 0;
  double start_rms_nm = 0;  ///< rms_nm of the eroded scan
  double offset_nm = 0;     ///< median difference
  double plane_rms_nm = 0;  ///< rms with the best plane taken off
  /// Shares of pixels within one and two posterior standard deviations, and within the interval of
  /// 95 %; 0 if these are unknown.
  double coverage_1 = 0, coverage_2 = 0, in_interval = 0;
  std::int64_t pixels = 0;
  std::vector<RegionReport> regions;  ///< those with pixels; none without deviations
};

/// A round in which Monte Carlo corrected the model of SEM images.
struct CorrectionRound {
  std::vector<double> off_share;    ///< per channel: rms of the correction over the mean yield
  std::vector<double> error_share;  ///< the same of its own error, from few electrons
  double moved_nm = 0;              ///< rms by which the surface moved, the mean apart
  std::int64_t primaries = 0;
  double seconds = 0;  ///< of simulating
};

/// Another surface, at another place in the scan, that explains both images.
struct RivalSurface {
  Reconstruction found;
  double probability = 0;  ///< of its place, among those that were judged
  double share_apart = 0;  ///< of heights that differ by more than two deviations of the difference
};

/// A further SEM image, before the fit.
struct PreparedView {
  StoredModel model;
  std::string signal;                     ///< as in ModelRequest
  double tilt_deg = 0, azimuth_deg = 0;   ///< as given
  double shift_x_nm = 0, shift_y_nm = 0;  ///< of its frame in the plane that it sees, as found
  double correlation = 0;                 ///< of the image with what the surface would look like
  double other_side = 0;  ///< the same of a beam that is tilted to the other side; 0: not looked at
  std::vector<double> gains;
  double offset = 0;
  SemNoise noise;
  std::string noise_from;
  std::int64_t saturated = 0;
  std::string doubt;  ///< why the image cannot be of this place from this side; empty: it can
};

enum class ReconstructionVerdict {
  sound,           ///< converged, and the residuals look like noise
  flagged,         ///< there is a result, but check `reasons` first
  not_registered,  ///< images seem unrelated, so nothing was reconstructed
};

struct ReconstructSummary {
  ReconstructionVerdict verdict = ReconstructionVerdict::sound;
  std::vector<std::string> reasons;   ///< reasons of a verdict other than sound, in words
  std::vector<std::string> warnings;  ///< warnings of all steps, as reported
  std::optional<PreparedAfm> afm;
  std::optional<StoredModel> model;
  std::optional<Pose> pose;
  PlaceDoubt place_doubt;                  ///< none where the pose is verified
  std::optional<Calibration> calibration;  ///< initial calibration; absent: it was given
  bool gains_tied = false;  ///< the channels cannot be told apart: one fixed gain for all
  std::optional<SemNoise> sem_noise;
  std::string sem_noise_from;  ///< source of the SEM noise, in words
  std::int64_t saturated = 0;  ///< number of saturated SEM pixels, which are left out
  std::vector<PreparedView> views;
  SemTilt tilt;  ///< what was added to the levelled scan, given or found with the SEM image
  std::vector<CorrectionRound> corrections;
  Reconstruction result;
  std::optional<RivalSurface> rival;
  std::vector<std::string> held;  ///< which image holds which part of the surface, in words
  std::optional<TruthReport> truth;
  bool resumed = false;
  std::vector<std::filesystem::path> written;
};

/// Runs the whole chain and writes into `folder`: surface.vti, .gsf and .glb, simulated_afm.vti,
/// simulated_sem.vti, history.csv, transform.json, tip.txt (and first_tip.txt if the tip was
/// fitted), model.json, report.json, panel.png; rival.vti and rival_transform.json where another
/// surface explains both images as well. While it runs, a file `checkpoint` there holds the
/// state after each scale: the same job, started again after cancellation (Interrupted is thrown)
/// or a crash, continues from it to the same bytes. A checkpoint of another job is discarded. If
/// the images seem unrelated, only transform.json and registration.png are written. Throws
/// UsageError, InvalidInput, FileError, Unsupported, Interrupted.
ReconstructSummary run(const ReconstructJob& job, const Reporter& reporter = {});

/// The files in `folder` that a run may write, the checkpoint included.
std::vector<std::filesystem::path> reconstruction_files(const std::filesystem::path& folder);

/// The options that the reconstruction runs with: tied gains are not refined, a tip that was found
/// blindly is refined.
ReconstructionOptions options_of(const ReconstructJob& job, const ReconstructSummary& summary);

/// "sound", "flagged" or "not registered".
const char* name(ReconstructionVerdict verdict);
const char* name(ReconstructionMethod method);

}  // namespace surf::workflow
