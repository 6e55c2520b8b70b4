// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/mc/scheduling/pilot.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// A file that a job writes, or holds open on the way.
struct DiskNeed {
  std::string what;  ///< "image.tif", "scratch file"
  std::filesystem::path folder;
  double bytes = 0;         ///< at most
  bool in_the_end = false;  ///< whether it is there when the job is done
};

struct MemoryNeed {
  std::string what;
  double bytes = 0;
};

/// What a simulation would take.
struct DryRun {
  mc::Scan scan;
  mc::SceneSummary scene;
  mc::MethodChoice choice;
  mc::Pilot pilot;
  int threads = 1, ranks = 1;  ///< of each rank, and how many
  /// Without libraries, which the pilot has made. Of a job with a time to keep to, that time.
  double expected_s = 0, standard_error_s = 0;
  std::vector<MemoryNeed> memory;  ///< of each rank
  double memory_bytes = 0;         ///< the peak
  double memory_there =
      0;  ///< as `memory_there` says, this process included; infinite: no limit is known
  std::vector<DiskNeed> disk;
  std::vector<std::string> warnings;
};

/// Checks everything as `run` does, builds the scene, makes or loads the libraries, simulates a
/// part of the units for about `seconds` and throws them away: nothing but libraries in the cache
/// is written. `ranks`: how many processes the job will be shared by; they are taken to be as fast
/// as this one. Throws as `run`, and Interrupted.
DryRun dry_run(SimulateJob job, int ranks = 1, double seconds = 10, const Reporter& reporter = {});

}  // namespace surf::workflow
