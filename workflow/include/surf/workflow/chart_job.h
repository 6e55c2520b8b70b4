// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/io/sim/scene_file.h"
#include "surf/sem/image_error.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// Times every way to make a scene's image and compares the images with a reference
/// (docs/how-to/chart.md).
struct ChartJob {
  io::SceneFile scene;
  std::filesystem::path folder;  ///< for all output; created if it is missing
  /// The finest accuracy that is asked of methods with a wanted accuracy, 0.001 to 0.1.
  double finest = 0.01;
  /// Accuracy of each pixel of the reference, at most half of `finest`. 0: a third of it.
  double reference_accuracy = 0;
  /// The approximate number of pixels in the reference, evenly spread over the image. Errors are
  /// those of these pixels.
  int compared_pixels = 1000;
  /// Settings with more primaries in the whole image are left out. For direct simulation the limit
  /// is a twentieth of it.
  double most_primaries = 3e8;
  /// Fast models are trained on generated surfaces: their number, pixels across, and primaries per
  /// pixel.
  int surfaces = 20, surface_px = 64;
  std::int64_t training_electrons = 150;
  std::vector<std::string> families;  ///< families of methods, from `chart_families`; empty: all
  bool quick = false;                 ///< few settings of each method
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per hardware thread. Affects times only
  std::string command_line;
};

/// All parameters except scene, training electrons and command line.
void describe(ParameterVisitor& visit, ChartJob& job);

/// A family of methods.
struct ChartFamily {
  std::string name;       ///< as in the option: "replay"
  std::string what;       ///< one line, no full stop
  bool simulates = true;  ///< Monte Carlo; false: a fast model
};
const std::vector<ChartFamily>& chart_families();

/// Whether a point meets an accuracy. The target of a pixel is the larger of `accuracy` times its
/// mean, and the floor.
struct ChartTarget {
  double accuracy = 0;
  /// Root mean square of error over target over all pixels, for the worst detector, with the
  /// reference's noise taken out.
  double rms = 0;
  double short_of = 0;  ///< share of pixels with a standard error above 1.1 times the target
  bool met = false;     ///< standard errors are known, rms <= 1.1, and short_of <= 2 %
};

struct ChartChannel {
  std::string name;  ///< SE, BSE
  ImageError error;
};

/// One method with one setting.
struct ChartPoint {
  std::string id;              ///< "replay-100"
  std::string family;          ///< "replay"
  std::string setting;         ///< in words: "100 electrons per pixel"
  double run_s = 0;            ///< wall time of the image
  double preparation_s = 0;    ///< wall time of the preparation: scene, library, training
  double peak_bytes = 0;       ///< additional memory at the peak; 0: unknown
  std::int64_t primaries = 0;  ///< primaries of the image; 0 for fast models
  bool is_default = false;     ///< the default behaviour of `simulate` with this scene
  std::vector<ChartChannel> channels;
  std::vector<ChartTarget> targets;  ///< one for each charted accuracy

  double total_s() const { return run_s + preparation_s; }
  double worst_rms() const;  ///< the largest rms error of its channels
};

/// The method chosen by default for an accuracy, compared with the fastest point that meets it.
struct ChartChoice {
  double accuracy = 0;
  std::string reason;  ///< as `simulate` prints it
  std::string id;      ///< the chosen point; empty if it was left out
  /// The fastest point that meets the accuracy, preparation included; empty: none does.
  std::string fastest;
  double ratio = 0;  ///< time of the chosen point divided by that of the fastest
  bool met = false;  ///< the chosen point meets the accuracy
};

struct ChartSummary {
  bool complete = true;  ///< false when cancelled; finished points are kept
  std::vector<ChartPoint> points;
  std::vector<ChartChoice> choices;
  std::vector<std::string> left_out;    ///< methods that are not on the chart, and why
  std::vector<ChartChannel> reference;  ///< only noise and mean of the reference
  int compared = 0;                     ///< number of compared pixels
  int found = 0;                        ///< points that an earlier run had finished
  std::vector<std::filesystem::path> written;
};

/// Called with each point as soon as it is finished.
using PointCallback = std::function<void(const ChartPoint&)>;

/// Makes the reference, runs the missing points, and writes to the folder:
///   chart.csv          a line for each point and channel
///   chart.json         the same, with choices and what was left out
///   chart.svg, .png    time against error
///   reference/N.exr    images whose mean is the reference
///   points/ID.json     each point; the same job continues from these
///   models/            fast models, and the images that they are trained on
/// The same job gives the same numbers again, except times and memory. Points of another job in the
/// folder are run again. Throws UsageError, FileError, and what simulations and trainings throw.
///
/// With a `team` all members call this with the same job. They share the reference and the training
/// images. The leader alone runs the points, so that their times stay comparable; the others wait.
/// The leader has the true summary. chart.run.json records how much each member did.
ChartSummary run(const ChartJob& job, const Reporter& reporter = {},
                 const PointCallback& on_point = {}, Team* team = nullptr);

/// The files in `folder` that a run may write, and its folders.
std::vector<std::filesystem::path> chart_files(const std::filesystem::path& folder);

}  // namespace surf::workflow
