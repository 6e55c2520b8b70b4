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

/// Charts how far off registration may begin, and how a reconstruction's error falls with its time,
/// on a sample whose truth is known (docs/how-to/chart_reconstruction.md). Tip, noise, gains and
/// (for reconstructions) the map are the true ones, so that the method alone is judged. Only the
/// family "chain" finds them itself, as `reconstruct` does.
struct ChainChartJob {
  std::filesystem::path sample;  ///< a folder that `semsurf sample` made
  std::filesystem::path folder;  ///< for all output; created if it is missing
  /// Fast model of SEM images; empty: a stored model is used, or one is trained and stored.
  std::filesystem::path model;
  std::filesystem::path models;  ///< where models are stored
  /// Families of methods, from `chain_chart_families`; empty: all.
  std::vector<std::string> families;
  bool quick = false;      ///< few settings of each method
  int draws = 0;           ///< draws per way and offset, 1 to 1000; 0: ten, or three if `quick`
  std::uint64_t seed = 1;  ///< seed of the draws
  int threads = 0;         ///< 0: one per hardware thread. Affects times only
  std::string command_line;
};

/// All parameters except sample, stored models and command line.
void describe(ParameterVisitor& visit, ChainChartJob& job);

struct ChainFamily {
  std::string name;       ///< as in the option: "landmarks"
  std::string what;       ///< one line, no full stop
  bool registers = true;  ///< false: it reconstructs
};
const std::vector<ChainFamily>& chain_chart_families();

/// Whether a folder holds a sample (truth.json is there).
bool is_sample(const std::filesystem::path& folder);

/// One way to register, with a start that is off by a given amount. Every way gets the same seeded
/// draws. Each draw is a part of the SEM image with 85 % of its sides, at a random place.
struct RegistrationPoint {
  std::string id;  ///< "landmarks-4px"
  std::string family;
  /// Offset of the start, in a random direction; for landmarks the root mean square offset of each.
  double offset_px = 0;
  double offset_deg = 0;   ///< rotation of the start about the part's middle, either way
  bool any_start = false;  ///< no start is needed: both offsets mean nothing
  int draws = 0;
  /// Draws with a verified result; all draws for landmarks alone, which have no verdict.
  int verified = 0;
  int right = 0;          ///< verified and within `right_px` of the truth (rms over the overlap)
  int wrong = 0;          ///< verified, but further off
  double median_px = 0;   ///< median error of the verified maps; 0 without any
  double largest_px = 0;  ///< largest error of the verified maps; 0 without any
  double median_s = 0;    ///< wall time of one registration

  double share() const { return draws > 0 ? double(right) / draws : 0; }
};
inline constexpr double right_px = 0.3;

/// The largest offset at which a way still succeeds in at least nine of ten draws, there and at all
/// smaller offsets tried.
struct CaptureRange {
  std::string family;
  bool any_start = false;
  std::optional<double> px, deg;           ///< absent: not tried, or never successful
  bool px_open = false, deg_open = false;  ///< no tried offset was too large
  double median_s = 0;                     ///< over the way's points
};

/// An intermediate surface, at the end of a scale or of the reconstruction.
struct ReconstructionStep {
  double sigma_px = 0;  ///< smoothing of the scale; 0 without scales
  double run_s = 0;     ///< time since the reconstruction began, without the measuring of errors
  double rms_nm = 0;    ///< error against the truth, with the mean difference taken off
};

struct ReconstructionPoint {
  std::string id;               ///< "gauss-newton"
  std::string family, setting;  ///< the setting in words
  bool is_default = false;      ///< the default behaviour of `reconstruct`
  double preparation_s = 0;     ///< tip, registration and gains, if they are found
  double peak_bytes = 0;        ///< additional memory at the peak; 0: unknown
  int iterations = 0, evaluations = 0, products = 0;
  std::string ended;                      ///< how the last scale ended
  std::vector<ReconstructionStep> steps;  ///< at least one

  double total_s() const { return preparation_s + steps.back().run_s; }
};

struct ChainChartSummary {
  bool complete = true;  ///< false when cancelled; finished points are kept
  std::string sample;    ///< name of the sample
  std::vector<RegistrationPoint> registrations;
  std::vector<CaptureRange> ranges;
  std::vector<ReconstructionPoint> reconstructions;
  double eroded_nm = 0;  ///< rms error of the eroded scan
  double floor_nm = 0;   ///< rms error that noise and prior alone leave; 0 without reconstructions
  std::vector<std::string> left_out;  ///< methods that are not on the chart, and why
  int found = 0;                      ///< points that an earlier run had finished
  std::vector<std::filesystem::path> written;
};

/// Called with each point as soon as it is finished.
struct ChainChartCallbacks {
  std::function<void(const RegistrationPoint&)> registration;
  std::function<void(const ReconstructionPoint&)> reconstruction;
};

/// Runs the missing points and writes to the folder:
///   registration.csv, .svg, .png     success and capture range against time
///   reconstruction.csv, .svg, .png   error against time, a line for each scale
///   chart.json                       all results, with what was left out
///   points/ID.json                   each point; the same job continues from these
/// A chart without points is left out. The same job gives the same numbers again, except times and
/// memory. Throws UsageError, FileError, and what the training of a model throws.
ChainChartSummary run(const ChainChartJob& job, const Reporter& reporter = {},
                      const ChainChartCallbacks& on_point = {});

/// The files in `folder` that a run may write, and the folder of points.
std::vector<std::filesystem::path> chain_chart_files(const std::filesystem::path& folder);

/// Computes the capture range of one family from its points.
CaptureRange capture_range(const std::vector<RegistrationPoint>& points, const std::string& family);

}  // namespace surf::workflow
