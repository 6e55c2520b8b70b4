// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/progress.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mc/simulate.h"

namespace surf::workflow {

/// Turns what the user asked into a scan: any two of size, pixel size and region, the third
/// follows; with one the specimen's extent gives the rest; with none 256 pixels across the longer
/// side. Three, or numbers that do not fit, are a UsageError. The specimen's extent is what the
/// beam sees of its box; the scan plane goes through mid-height, so that a tilted view is centred
/// too. A region and a pixel size must fit each other to 1e-6 of whole pixels.
mc::Scan resolve_scan(const io::ScanRequest& request, const Box& specimen_extent,
                      const mc::Beam& beam);

/// One simulation from specimen to files.
struct SimulateJob {
  io::SceneFile scene;                            ///< with the command line's overrides applied
  mc::SimulationOptions options;
  std::vector<std::filesystem::path> outputs;     ///< formats by extension; at least one
  std::string png_channel;                        ///< for PNG; empty: SE
  std::string command_line;                       ///< for the sidecar
};

struct SimulateSummary {
  mc::SimulationResult result;
  mc::Scan scan;
  mc::SceneSummary scene;
  std::vector<std::string> warnings;
  std::vector<std::filesystem::path> written;     ///< outputs and their .run.json sidecars
};

/// Checks everything that can be wrong before spending time (targets writable, channel known), then
/// builds the scene, simulates, and writes every output and its sidecar `NAME.run.json`. When
/// cancelled the files are written with `partial = true` in their metadata.
SimulateSummary run(const SimulateJob& job, const ProgressCallback& progress = {},
                    const CancelToken* cancel = nullptr);

}  // namespace surf::workflow
