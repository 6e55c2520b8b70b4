// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surf/reconstruction/reconstruct.h"
#include "surf/sem/calibration.h"
#include "surf/workflow/register_job.h"

namespace surf::workflow {

/// Gains and offset, where they are known.
struct GivenCalibration {
  std::vector<double> gains;  ///< one per channel of the model
  double offset = 0;
};

/// One surface from an AFM scan and an SEM image, or from one of them: the chain of the thesis's
/// figure 1-3.
struct ReconstructJob {
  std::optional<AfmInput> afm;
  std::optional<SemInput> sem;
  ModelRequest model;
  PoseOptions pose;
  std::optional<GivenCalibration>
      calibration;                    ///< needed without a scan, which it is fitted with otherwise
  std::optional<SemNoise> sem_noise;  ///< absent: estimated
  int upsample = 3;                   ///< of the scan, see AfmData
  std::optional<bool>
      refine_tip;                 ///< fit the tip with the surface; absent: if it was found blindly
  ReconstructionOptions options;  ///< its threads are for all steps; `refine_tip` is as above
  std::optional<HeightField>
      truth;  ///< in the SEM's frame, or the scan's without an SEM image: to compare with
  std::filesystem::path truth_file;
  std::filesystem::path
      folder;  ///< of the result; made where it is missing. Empty: no files are written
  std::string command_line;  ///< as given, for the record
  bool picture = true;       ///< panel.png, which needs Python with Matplotlib
};
/// Those of the inputs that there are, of the options, and of the output.
void describe(ParameterVisitor& visit, ReconstructJob& job);

/// How far a surface is from the true one. A scan does not know where 0 is, so the mean difference
/// is taken off.
struct TruthReport {
  double rms_nm = 0;
  double start_rms_nm = 0;  ///< of the eroded scan, likewise
  double offset_nm = 0;     ///< the mean difference
  double plane_rms_nm = 0;  ///< with the best plane taken off
  double coverage_1 = 0,
         coverage_2 = 0;  ///< shares within one and two standard deviations; 0 without deviations
  std::int64_t pixels = 0;
};

enum class ReconstructionVerdict {
  sound,           ///< converged, and the residuals look like noise
  flagged,         ///< there is a result, but look at `reasons` first
  not_registered,  ///< the registration is not verified: nothing was reconstructed
};

struct ReconstructSummary {
  ReconstructionVerdict verdict = ReconstructionVerdict::sound;
  std::vector<std::string> reasons;   ///< of a verdict other than sound, for people
  std::vector<std::string> warnings;  ///< of all steps, as they were told
  std::optional<PreparedAfm> afm;
  std::optional<StoredModel> model;
  std::optional<Pose> pose;
  std::optional<Calibration> calibration;  ///< that the reconstruction begins with; absent: given
  bool gains_tied = false;  ///< the channels cannot be told apart: one gain for all, not refined
  std::optional<SemNoise> sem_noise;
  std::string sem_noise_from;  ///< where it comes from, in words
  std::int64_t saturated = 0;  ///< SEM pixels left out
  Reconstruction result;
  std::optional<TruthReport> truth;
  bool resumed = false;
  std::vector<std::filesystem::path> written;
};

/// Does it all and writes into `folder`: surface.vti, .gsf and .glb, simulated_afm.vti,
/// simulated_sem.vti, history.csv, transform.json, tip.txt (and first_tip.txt where it was fitted),
/// model.json, report.json, panel.png. While it works a file `checkpoint` there holds what is done
/// after each scale: the same job, started again, goes on from it to the same bytes, whether it was
/// cancelled (Interrupted is thrown) or killed. One of another job is begun anew. Nothing is
/// written where the registration is not verified, but transform.json and registration.png. Throws
/// UsageError, InvalidInput, FileError, Unsupported, Interrupted.
ReconstructSummary run(const ReconstructJob& job, const Reporter& reporter = {});

/// The files in `folder` that a run may write, the checkpoint included.
std::vector<std::filesystem::path> reconstruction_files(const std::filesystem::path& folder);

/// As the reconstruction runs with: gains that are tied are not refined, a tip that was found
/// blindly is.
ReconstructionOptions options_of(const ReconstructJob& job, const ReconstructSummary& summary);

/// "sound", "flagged" or "not registered".
const char* name(ReconstructionVerdict verdict);
const char* name(ReconstructionMethod method);

}  // namespace surf::workflow
