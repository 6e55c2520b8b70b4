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
#include "surf/sem/guided_estimate.h"
#include "surf/workflow/charging.h"
#include "surf/workflow/estimate_options.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/simplify_specimen.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// Turns a request into a scan. With any two of size, pixel size and region the third follows. With
/// one of them the specimen's extent gives the rest. With none there are 256 pixels across the
/// longer side. All three, or numbers that do not fit, are a UsageError. The specimen's extent is
/// its box as seen by the beam. The scan plane goes through mid-height, so that a tilted view is
/// centred too. A region must be a whole number of pixels to 1e-6.
mc::Scan resolve_scan(const mc::ScanRequest& request, const Box& specimen_extent,
                      const mc::Beam& beam);

/// Outputs besides the image. File names are made from the first output's name: for out.exr
/// out.spectra.csv, out.deposit.vti, out.tracks.vtp and out.tracks.png.
struct Extras {
  /// Channels besides those of the detectors. What the beam sees: "z_nm", "normal" (three
  /// channels), "material". How each pixel was simulated: "electrons" (primaries whose counts were
  /// kept), "model" (the number of the mc::PixelModel), "variance_left" (one channel per detector).
  /// Of guided images: "radius" (in pixels, of the disc whose mean would be as noisy), "plain"
  /// (mean and standard error without guides). "counts": sums and sums of squares of the primaries'
  /// numbers, of all and of those of odd number, from which `semsurf estimate` makes guided images.
  std::vector<std::string> channels;
  /// Deposited energy on a grid, with this many cells along its longest side.
  int deposit_cells = 0;
  int trajectories = 0;  ///< tracks of this many primaries, at most 100000
  /// Where these primaries land in the scan plane, nm; absent: the middle of the scan.
  std::optional<std::pair<double, double>> trajectories_at_nm;
};

/// Checkpoints of a long job: the same job, started again, continues from the checkpoint to the
/// same bytes. The same job means the same specimen, settings and program; threads, outputs and
/// their place may differ. Deposited energy cannot be stored: with `deposit_cells` there is no
/// checkpoint.
struct CheckpointOptions {
  bool wanted = true;
  /// The checkpoint file. Empty: NAME.FFFFFFFF.checkpoint beside the first output. F is made from
  /// everything that determines the result, so that a changed job neither uses nor touches it.
  std::filesystem::path file;
  /// Interval between writes, > 0; the first write is after 10 s at the latest.
  double seconds = 30;
  bool restart = false;  ///< ignore an existing checkpoint
};

void describe(ParameterVisitor& visit, Extras& extras);
void describe(ParameterVisitor& visit, CheckpointOptions& checkpoint);

/// One simulation from specimen to files, or to memory alone.
struct SimulateJob {
  io::SceneFile scene;  ///< the requested simulation
  mc::Execution execution;
  EstimateOptions estimate;
  bool spectra = false;         ///< record energies and angles per detector
  std::filesystem::path cache;  ///< where libraries are stored; empty: nowhere
  Extras extras;
  CheckpointOptions checkpoint;
  /// Output files, formats by extension; none: results stay in the summary.
  std::vector<std::filesystem::path> outputs;
  std::string png_channel;  ///< channel shown in a PNG; empty: SE, or SE.shot with a dose
  io::Layout layout = io::Layout::automatic;  ///< of EXR and TIFF
  bool keep_image = false;                    ///< also in memory, with all its channels
  std::string command_line;                   ///< for the sidecar
};

/// All parameters except the specimen: the request, its execution, and the outputs.
void describe(ParameterVisitor& visit, SimulateJob& job);

/// What guides have brought a detector's image, over the pixels that see the specimen.
struct GuidedGain {
  double error_share = 0;  ///< root mean square of the error over the pixel's yield
  double plain_share = 0;  ///< the same without guides, by the scatter of the counts
  /// How many times as many electrons it would take without.
  double electrons() const {
    return error_share > 0 ? plain_share * plain_share / (error_share * error_share) : 1;
  }
};

struct SimulateSummary {
  mc::SimulationResult result;
  mc::ResultSummary statistics;  ///< statistics of the result
  /// Estimates per detector, with `Estimate::guided`; before the detector's efficiency.
  std::vector<GuidedImage> guided;
  std::vector<GuidedGain> gains;     ///< per detector, with `Estimate::guided`
  std::string guided_by;             ///< what guided them, for people
  int rounds = 1;                    ///< of adding electrons
  std::optional<Charging> charging;  ///< of insulating materials
  /// With a wanted accuracy: whether the tier of physics is good enough for it.
  std::optional<std::string> tier;
  mc::MethodChoice choice;
  std::size_t pages_loaded = 0, pages_made = 0;  ///< library pages loaded from the cache, and made
  mc::Scan scan;
  Simplification simplification;  ///< made with the scene's mesh_tolerance_nm
  mc::SceneSummary scene;
  std::vector<std::string> warnings;
  /// Everything that affects the result, and its balance: the metadata of an image.
  Record record;
  Image image;                ///< with all channels; empty without SimulateJob::keep_image
  std::vector<Track> tracks;  ///< the tracks asked for by the extras of a job without outputs
  std::vector<std::filesystem::path> written;  ///< outputs, extras and their .run.json sidecars
  std::vector<TeamMember> team;                ///< work of each member; none without a team
};

/// The image of a job without its extra channels: means and standard errors, or guided estimates.
Image image_of(const SimulateSummary& summary);

/// A function that replaces `mc::simulate`: it may take units done elsewhere, or let somebody
/// watch.
using Simulator =
    std::function<mc::SimulationResult(const mc::Scene& scene, const mc::SimulationOptions& options,
                                       const mc::SimulationContext& context)>;

/// Checks everything that can be wrong before spending time (targets writable, channel known). Then
/// simplifies the specimen if asked to, builds the scene, simulates, and writes every output and
/// its sidecar `NAME.run.json`. If cancelled, the files are written with `partial = true` in their
/// metadata, and a checkpoint remains from which the same job continues. The checkpoint is deleted
/// when the job is done. Throws Interrupted if cancelled before there is anything to write,
/// FileError for a checkpoint that cannot be continued. Progress is in primaries, with a wanted
/// accuracy in pixels, and before that in cascades. Warnings come as soon as they are known, those
/// about likely mistakes before the simulation.
///
/// With a `team` all members call this with the same job and share its units of work. The leader
/// writes and reports, and has the true summary. The bytes are the same as with one process.
/// Deposited energy is not available with a team (UsageError).
SimulateSummary run(SimulateJob job, const Reporter& reporter = {}, Team* team = nullptr,
                    const Simulator& simulator = {});

}  // namespace surf::workflow
