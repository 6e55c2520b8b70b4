// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/parameters.h"
#include "surf/core/track.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mc/results/result_summary.h"
#include "surf/mc/sampling/choose_method.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/charging.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/simplify_specimen.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// Turns what the user asked into a scan: any two of size, pixel size and region, the third
/// follows; with one the specimen's extent gives the rest; with none 256 pixels across the longer
/// side. Three, or numbers that do not fit, are a UsageError. The specimen's extent is what the
/// beam sees of its box; the scan plane goes through mid-height, so that a tilted view is centred
/// too. A region and a pixel size must fit each other to 1e-6 of whole pixels.
mc::Scan resolve_scan(const mc::ScanRequest& request, const Box& specimen_extent,
                      const mc::Beam& beam);

/// What is wanted besides the image. File names are made from the first output's: for out.exr
/// out.spectra.csv, out.deposit.vti, out.tracks.vtp and out.tracks.png.
struct Extras {
  /// Channels besides those of the detectors. What the beam sees: "z_nm", "normal" (three
  /// channels), "material". How it was simulated: "electrons" (per pixel, whose counts were kept),
  /// "model" (the number of the mc::PixelModel), "variance_left" (one channel for each detector).
  std::vector<std::string> channels;
  int deposit_cells = 0;  ///< deposited energy on a grid, this many cells along its longest side
  int trajectories = 0;   ///< tracks of this many primaries, at most 100000
  /// Where in the scan plane they land, nm; absent: in the middle of the scan.
  std::optional<std::pair<double, double>> trajectories_at_nm;
};

/// How the work of a long job is kept on the way, so that the same job, started again, goes on from
/// there to the same bytes: the same specimen, settings and program; threads, outputs and their
/// place may differ. Deposited energy cannot be kept: with `deposit_cells` there is no checkpoint.
struct CheckpointOptions {
  bool wanted = true;
  /// Where to; empty: NAME.FFFFFFFF.checkpoint beside the first output, F made from all that
  /// determines the result, so that a changed job neither takes nor touches it.
  std::filesystem::path file;
  double seconds = 30;   ///< between writes, above 0; the first after 10 s at the latest
  bool restart = false;  ///< begin anew, whatever there is
};

void describe(ParameterVisitor& visit, Extras& extras);
void describe(ParameterVisitor& visit, CheckpointOptions& checkpoint);

/// One simulation from specimen to files, or to memory alone.
struct SimulateJob {
  io::SceneFile scene;  ///< what is asked for
  mc::Execution execution;
  bool spectra = false;         ///< energies and angles per detector
  std::filesystem::path cache;  ///< where libraries are kept; empty: nowhere
  Extras extras;
  CheckpointOptions checkpoint;
  std::vector<std::filesystem::path>
      outputs;              ///< formats by extension; none: results stay in the summary
  std::string png_channel;  ///< for PNG; empty: SE, or SE.shot with a dose
  io::Layout layout = io::Layout::automatic;  ///< of EXR and TIFF
  std::string command_line;                   ///< for the sidecar
};

/// All but the specimen: the request, how it is carried out, and what is written.
void describe(ParameterVisitor& visit, SimulateJob& job);

struct SimulateSummary {
  mc::SimulationResult result;
  mc::ResultSummary statistics;      ///< of the result
  std::optional<Charging> charging;  ///< of insulators
  std::optional<std::string>
      tier;  ///< with a wanted accuracy: whether the tier of physics is good enough for it
  mc::MethodChoice choice;
  std::size_t pages_loaded = 0, pages_made = 0;  ///< of libraries, from the cache and not
  mc::Scan scan;
  Simplification simplification;  ///< with the scene's mesh_tolerance_nm
  mc::SceneSummary scene;
  std::vector<std::string> warnings;
  Record record;  ///< everything that changes the result, and its balance: an image's metadata
  std::vector<Track> tracks;  ///< of a job without outputs, where its extras ask for them
  std::vector<std::filesystem::path> written;  ///< outputs, extras and their .run.json sidecars
  std::vector<TeamMember> team;                ///< who did how much; none without a team
};

/// How a scene is simulated, in place of `mc::simulate`: with units done elsewhere, or with
/// somebody looking on.
using Simulator =
    std::function<mc::SimulationResult(const mc::Scene& scene, const mc::SimulationOptions& options,
                                       const mc::SimulationContext& context)>;

/// Checks everything that can be wrong before spending time (targets writable, channel known), then
/// simplifies the specimen where that is asked for, builds the scene, simulates, and writes every
/// output and its sidecar `NAME.run.json`. When cancelled the files are written with `partial =
/// true` in their metadata, and a checkpoint is left for the same job to go on from; it is deleted
/// when the job is done. Cancelled before there is anything to write it throws Interrupted. One
/// that cannot be gone on from is a FileError. Progress is in primaries, with a wanted accuracy in
/// pixels, and before that in cascades. Warnings come as soon as they are known: what looks like a
/// mistake comes before the simulation.
///
/// With a `team` all of it call this with the same job, and share its units of work; the leader
/// writes and tells, and its summary is the true one. Bytes are those of one process. Deposited
/// energy cannot be had so (UsageError).
SimulateSummary run(SimulateJob job, const Reporter& reporter = {}, Team* team = nullptr,
                    const Simulator& simulator = {});

}  // namespace surf::workflow
