// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/mc/scheduling/pilot.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// A file that a job writes, or holds open while it runs.
struct DiskNeed {
  std::string what;  ///< "image.tif", "scratch file"
  std::filesystem::path folder;
  double bytes = 0;         ///< upper limit
  bool in_the_end = false;  ///< the file remains when the job is done
};

struct MemoryNeed {
  std::string what;
  double bytes = 0;
};

/// The time, memory and disk space that a simulation would take.
struct DryRun {
  mc::Scan scan;
  mc::SceneSummary scene;
  mc::MethodChoice choice;
  mc::Pilot pilot;
  int threads = 1, ranks = 1;  ///< threads per rank, and number of ranks
  /// Expected time without the making of libraries, which the pilot has made. For a job with a time
  /// budget, that time.
  double expected_s = 0, standard_error_s = 0;
  std::vector<MemoryNeed> memory;  ///< per rank
  double memory_bytes = 0;         ///< peak of each rank
  /// Result of `memory_there`, this process included; infinite: no limit is known.
  double memory_there = 0;
  std::vector<DiskNeed> disk;
  std::vector<std::string> warnings;
};

/// Checks everything as `run` does, builds the scene, makes or loads the libraries, and simulates
/// part of the units for about `seconds`. The results are discarded: only libraries in the cache
/// are written. `ranks` is the number of processes that will share the job; they are assumed to be
/// as fast as this one. Throws what `run` throws, and Interrupted.
DryRun dry_run(SimulateJob job, int ranks = 1, double seconds = 10, const Reporter& reporter = {});

}  // namespace surf::workflow
