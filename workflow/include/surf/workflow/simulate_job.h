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
#include "surf/core/progress.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mc/choose_method.h"
#include "surf/mc/result_summary.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/simplify_specimen.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// Turns what the user asked into a scan: any two of size, pixel size and region, the third
/// follows; with one the specimen's extent gives the rest; with none 256 pixels across the longer
/// side. Three, or numbers that do not fit, are a UsageError. The specimen's extent is what the
/// beam sees of its box; the scan plane goes through mid-height, so that a tilted view is centred
/// too. A region and a pixel size must fit each other to 1e-6 of whole pixels.
mc::Scan resolve_scan(const io::ScanRequest& request, const Box& specimen_extent,
                      const mc::Beam& beam);

/// What is wanted besides the image. File names are made from the first output's: for out.exr
/// out.spectra.csv, out.deposit.vti, out.tracks.vtp and out.tracks.png.
struct Extras {
  /// Channels besides those of the detectors. What the beam sees: "z_nm", "normal" (three channels),
  /// "material". How it was simulated: "electrons" (per pixel, whose counts were kept), "model" (the
  /// number of the mc::PixelModel), "variance_left" (one channel for each detector).
  std::vector<std::string> channels;
  int deposit_cells = 0;        ///< deposited energy on a grid, this many cells along its longest side
  int trajectories = 0;         ///< tracks of this many primaries, at most 100000
  /// Where in the scan plane they land, nm; absent: in the middle of the scan.
  std::optional<std::pair<double, double>> trajectories_at_nm;
};

/// How the work of a long job is kept on the way, so that the same job, started again, goes on from
/// there to the same bytes: the same specimen, settings and program; threads, outputs and their place
/// may differ. Deposited energy cannot be kept: with `deposit_cells` there is no checkpoint.
struct CheckpointOptions {
  bool wanted = true;
  /// Where to; empty: NAME.FFFFFFFF.checkpoint beside the first output, F made from all that
  /// determines the result, so that a changed job neither takes nor touches it.
  std::filesystem::path file;
  double seconds = 30;           ///< between writes, above 0; the first after 10 s at the latest
  bool restart = false;          ///< begin anew, whatever there is
};

/// One simulation from specimen to files.
struct SimulateJob {
  io::SceneFile scene;                            ///< with the command line's overrides applied
  /// Its detectors come before the scene's. The method is set as the scene says, or chosen
  /// (mc::choose_method); the scene's accuracy goes before the one here.
  mc::SimulationOptions options;
  /// Above 0: the wall time, s, that the job may take. A coarse simulation tells which accuracy fits.
  double seconds = 0;
  std::filesystem::path cache;                    ///< where libraries are kept; empty: nowhere
  Extras extras;
  CheckpointOptions checkpoint;
  std::vector<std::filesystem::path> outputs;     ///< formats by extension; at least one
  std::string png_channel;                        ///< for PNG; empty: SE, or SE.shot with a dose
  io::Layout layout = io::Layout::automatic;      ///< of EXR and TIFF
  std::string command_line;                       ///< for the sidecar
};

struct SimulateSummary {
  mc::SimulationResult result;
  mc::ResultSummary statistics;                   ///< of the result
  mc::MethodChoice choice;
  std::size_t pages_loaded = 0, pages_made = 0;   ///< of libraries, from the cache and not
  mc::Scan scan;
  Simplification simplification;                  ///< with the scene's mesh_tolerance_nm
  mc::SceneSummary scene;
  std::vector<std::string> warnings;
  std::vector<std::filesystem::path> written;     ///< outputs, extras and their .run.json sidecars
  std::vector<TeamMember> team;                   ///< who did how much; none without a team
};

/// Is told of every warning as soon as it is known: what looks like a mistake comes before the
/// simulation.
using WarningCallback = std::function<void(const std::string&)>;

/// Is told what is good to know and no mistake: that a job is resumed, where its checkpoint is.
using NoteCallback = std::function<void(const std::string&)>;

/// Is told of progress in getting libraries, in cascades.
using LibraryCallback = ProgressCallback;

/// Checks everything that can be wrong before spending time (targets writable, channel known), then
/// simplifies the specimen where that is asked for, builds the scene, simulates, and writes every output and its sidecar `NAME.run.json`. When
/// cancelled the files are written with `partial = true` in their metadata, and a checkpoint is left
/// for the same job to go on from; it is deleted when the job is done. Cancelled before there is anything to write
/// it throws Interrupted. One that cannot be gone on from
/// is a FileError. Progress is in primaries, with a wanted accuracy in pixels.
///
/// With a `team` all of it call this with the same job, and share its units of work; the leader writes and tells, and its
/// summary is the true one. Bytes are those of one process. Deposited energy cannot be had so (UsageError).
SimulateSummary run(SimulateJob job, const ProgressCallback& progress = {},
                    const CancelToken* cancel = nullptr, const WarningCallback& warn = {},
                    const NoteCallback& note = {}, const LibraryCallback& libraries = {},
                    Team* team = nullptr);

}  // namespace surf::workflow
