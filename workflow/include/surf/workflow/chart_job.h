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

/// Every way to make a scene's image, timed and compared with a reference (docs/chart.md).
struct ChartJob {
  io::SceneFile scene;
  std::filesystem::path folder;  ///< for everything that is written; made if it is not there
  /// The finest that is asked of methods with a wanted accuracy, 0.001 to 0.1.
  double finest = 0.01;
  /// Of the reference, for each pixel; below half of `finest`. 0: a third of it.
  double reference_accuracy = 0;
  /// The reference has about so many pixels, evenly spread over the image; errors are those of
  /// these.
  int compared_pixels = 1000;
  /// Settings with more primaries in the whole image are left out; of direct simulation, with more
  /// than a twentieth of it.
  double most_primaries = 3e8;
  /// Of the program's own surfaces that fast models are learnt on: how many, pixels across, and
  /// primaries of each pixel.
  int surfaces = 20, surface_px = 64;
  std::int64_t training_electrons = 150;
  std::vector<std::string> families;  ///< of methods, of `chart_families`; empty: all
  bool quick = false;                 ///< few settings of each method
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per hardware thread. Changes times only
  std::string command_line;
};

/// All but scene, training electrons and command line.
void describe(ParameterVisitor& visit, ChartJob& job);

/// A family of methods, for people.
struct ChartFamily {
  std::string name;       ///< as the command line takes it: "replay"
  std::string what;       ///< one line, no full stop
  bool simulates = true;  ///< by Monte Carlo; else by a fast model
};
const std::vector<ChartFamily>& chart_families();

/// How the standard errors and the errors of a point compare with what an accuracy asks for: the
/// larger of `accuracy` times a pixel's mean, and the floor.
struct ChartTarget {
  double accuracy = 0;
  double rms = 0;       ///< of error over target, over the pixels, of the worst detector; the
                        ///< reference's noise taken out
  double short_of = 0;  ///< share of pixels whose own standard error is above 1.1 times the target
  bool met = false;     ///< rms at most 1.1, and at most 2 % of pixels short of it; standard errors
                        ///< have to be known
};

struct ChartChannel {
  std::string name;  ///< SE, BSE
  ImageError error;
};

/// One method with one setting.
struct ChartPoint {
  std::string id;              ///< "replay-100"
  std::string family;          ///< "replay"
  std::string setting;         ///< for people: "100 electrons per pixel"
  double run_s = 0;            ///< wall time of the image
  double preparation_s = 0;    ///< wall time of what it takes before: scene, library, training
  double peak_bytes = 0;       ///< memory above what was in use before; 0: not known
  std::int64_t primaries = 0;  ///< of the image; 0 for fast models
  bool is_default = false;     ///< what `simulate` does with this scene, nothing else being asked
  std::vector<ChartChannel> channels;
  std::vector<ChartTarget> targets;  ///< one for each accuracy that is charted

  double total_s() const { return run_s + preparation_s; }
  double worst_rms() const;  ///< of its channels
};

/// What a simulation of an accuracy takes, beside the fastest point that meets it.
struct ChartChoice {
  double accuracy = 0;
  std::string reason;   ///< as `simulate` prints it
  std::string id;       ///< of the point; empty where it was left out
  std::string fastest;  ///< of those that meet the accuracy, preparation included; empty: none does
  double ratio = 0;     ///< time of the one over the other
  bool met = false;     ///< by the chosen point
};

struct ChartSummary {
  bool complete = true;  ///< false when cancelled; finished points are kept
  std::vector<ChartPoint> points;
  std::vector<ChartChoice> choices;
  std::vector<std::string> left_out;    ///< what is not on the chart, and why
  std::vector<ChartChannel> reference;  ///< only its noise and its mean
  int compared = 0;                     ///< pixels
  int found = 0;                        ///< points that were there before
  std::vector<std::filesystem::path> written;
};

/// Is told of each point as soon as it is there.
using PointCallback = std::function<void(const ChartPoint&)>;

/// Makes the reference, runs what is not there yet, and writes to the folder:
///   chart.csv          a line for each point and channel
///   chart.json         the same, with choices and what was left out
///   chart.svg, .png    time against error
///   reference/N.exr    the reference's pixels, of which it is the mean
///   points/ID.json     each point, from which the same job goes on
///   models/            fast models, and images that they learn from
/// The same job gives the same numbers again, but for times and memory. Points of another job in
/// the folder are run again. Throws UsageError, FileError, and what simulations and trainings
/// throw.
///
/// With a `team` all of it call this with the same job, and share the reference and the images that
/// models learn from. Points, whose times are to mean the same, are the leader's alone, which has
/// the true summary; the others wait meanwhile. Who did how much is in chart.run.json.
ChartSummary run(const ChartJob& job, const Reporter& reporter = {},
                 const PointCallback& on_point = {}, Team* team = nullptr);

/// The files in `folder` that a run may write, and its folders.
std::vector<std::filesystem::path> chart_files(const std::filesystem::path& folder);

}  // namespace surf::workflow
