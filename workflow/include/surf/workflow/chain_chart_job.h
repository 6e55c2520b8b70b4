// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// How far off registration may begin, and what a reconstruction's time buys, on a sample whose
/// truth is known (docs/chart_reconstruction.md). Tip, noise, gains and the map (of
/// reconstructions) are the true ones, so that it is the method that is judged; the family "chain"
/// alone finds them all, as `reconstruct` does.
struct ChainChartJob {
  std::filesystem::path sample;  ///< a folder that `semsurf sample` made
  std::filesystem::path folder;  ///< for everything that is written; made if it is not there
  std::filesystem::path
      model;  ///< of SEM images; empty: one that was kept is found, or trained and kept
  std::filesystem::path models;       ///< where models are kept
  std::vector<std::string> families;  ///< of methods, of `chain_chart_families`; empty: all
  bool quick = false;                 ///< few settings of each method
  int draws = 0;           ///< of each way and offset, 1 to 1000; 0: ten, three where it is quick
  std::uint64_t seed = 1;  ///< of the draws
  int threads = 0;         ///< 0: one per hardware thread. Changes times only
  std::string command_line;
};

/// All but sample, kept models and command line.
void describe(ParameterVisitor& visit, ChainChartJob& job);

struct ChainFamily {
  std::string name;       ///< as the command line takes it: "landmarks"
  std::string what;       ///< one line, no full stop
  bool registers = true;  ///< else it reconstructs
};
const std::vector<ChainFamily>& chain_chart_families();

/// Whether a folder holds a sample (truth.json is there).
bool is_sample(const std::filesystem::path& folder);

/// One way to register, begun so far off: the same seeded draws for every way. Each is a part of
/// the SEM image, 85 % of its sides, somewhere in it.
struct RegistrationPoint {
  std::string id;  ///< "landmarks-4px"
  std::string family;
  double offset_px =
      0;  ///< of the start, in a random direction; of landmarks each one's, root mean square
  double offset_deg = 0;   ///< of the start, a turn about the part's middle, either way
  bool any_start = false;  ///< there is none: both offsets say nothing
  int draws = 0;
  int verified = 0;       ///< landmarks alone have no verdict: all count as verified
  int right = 0;          ///< verified and within `right_px` of the truth, rms over the overlap
  int wrong = 0;          ///< verified, and not
  double median_px = 0;   ///< that the map is off, of those that are verified; 0 without any
  double largest_px = 0;  ///< likewise
  double median_s = 0;    ///< wall time of one registration

  double share() const { return draws > 0 ? double(right) / draws : 0; }
};
inline constexpr double right_px = 0.3;

/// Where a way still arrives, nine times of ten and more, there and at all smaller offsets that
/// were tried.
struct CaptureRange {
  std::string family;
  bool any_start = false;
  std::optional<double> px, deg;           ///< absent: not tried, or never
  bool px_open = false, deg_open = false;  ///< none tried was too far
  double median_s = 0;                     ///< over the way's points
};

/// A surface on the way, at the end of a scale or of the whole.
struct ReconstructionStep {
  double sigma_px = 0;  ///< of the scale; 0 without scales
  double run_s = 0;     ///< since the reconstruction began, measuring errors left out
  double rms_nm = 0;    ///< against the truth, the mean difference taken off
};

struct ReconstructionPoint {
  std::string id;               ///< "gauss-newton"
  std::string family, setting;  ///< the latter for people
  bool is_default = false;      ///< what `reconstruct` does, nothing else being asked
  double preparation_s = 0;     ///< tip, registration, gains, where they are found
  double peak_bytes = 0;        ///< memory above what was in use before; 0: not known
  int iterations = 0, evaluations = 0, products = 0;
  std::string ended;                      ///< of the last scale
  std::vector<ReconstructionStep> steps;  ///< at least one

  double total_s() const { return preparation_s + steps.back().run_s; }
};

struct ChainChartSummary {
  bool complete = true;  ///< false when cancelled; finished points are kept
  std::string sample;    ///< its name
  std::vector<RegistrationPoint> registrations;
  std::vector<CaptureRange> ranges;
  std::vector<ReconstructionPoint> reconstructions;
  double eroded_nm = 0;  ///< rms error of the scan with the tip taken off
  double floor_nm = 0;   ///< that noise and prior alone leave; 0 where nothing was reconstructed
  std::vector<std::string> left_out;  ///< what is not on the chart, and why
  int found = 0;                      ///< points that were there before
  std::vector<std::filesystem::path> written;
};

/// Is told of each point as soon as it is there.
struct ChainChartCallbacks {
  std::function<void(const RegistrationPoint&)> registration;
  std::function<void(const ReconstructionPoint&)> reconstruction;
};

/// Runs what is not there yet, and writes to the folder:
///   registration.csv, .svg, .png     success and capture range against time
///   reconstruction.csv, .svg, .png   error against time, a line for each scale
///   chart.json                       all of it, with what was left out
///   points/ID.json                   each point, from which the same job goes on
/// Charts of which no point was asked for are left out. The same job gives the same numbers again,
/// but for times and memory. Throws UsageError, FileError, and what the training of a model throws.
ChainChartSummary run(const ChainChartJob& job, const Reporter& reporter = {},
                      const ChainChartCallbacks& on_point = {});

/// The files in `folder` that a run may write, and the folder of points.
std::vector<std::filesystem::path> chain_chart_files(const std::filesystem::path& folder);

/// Of points of one way.
CaptureRange capture_range(const std::vector<RegistrationPoint>& points, const std::string& family);

}  // namespace surf::workflow
