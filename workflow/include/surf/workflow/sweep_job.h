// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// One simulation of a sweep.
struct SweepRun {
  std::vector<std::string> values;  ///< values on the axes, as text: "500eV"
  /// Makes the job; its outputs are in the sweep's folder. Called when the run begins, so that not
  /// all specimens need to be in memory.
  std::function<SimulateJob()> make;
};

/// Simulates over a grid of settings (docs/how-to/many_machines.md).
struct SweepJob {
  std::filesystem::path folder;   ///< for all output; created if it is missing
  std::vector<std::string> axes;  ///< names of the varied settings: "energy", "tilt"
  std::vector<SweepRun> runs;     ///< all runs, for every part
  int part = 1, parts = 1;  ///< 1 to `parts`; part k does the runs k, k + parts, k + 2 parts ...
  std::string command_line;
};

/// The parameters for folder and part.
void describe(ParameterVisitor& visit, SweepJob& job);

struct SweepSummary {
  bool complete = true;  ///< false if cancelled; finished runs are kept
  /// Finished runs of this part, and those among them from earlier jobs.
  std::size_t done = 0, found = 0;
  std::size_t untrustworthy = 0;  ///< runs that missed their accuracy
  std::filesystem::path table;    ///< sweep.csv, or the table of the part
};

/// The mean yield in a run's image.
struct SweepYield {
  std::string detector;
  double mean = 0, standard_error = 0;
};

/// Called for each run of this process's part that is simulated now.
using RunCallback = std::function<void(std::size_t run, const std::vector<SweepYield>& yields)>;

/// Simulates the missing runs and writes the table: a line for each run with its values, its file,
/// and per detector the mean yield with its standard error. The result of a run is stored in
/// records/N.json of the folder. A run that was done before with the same settings by the same
/// program is not repeated. With one part the table is sweep.csv, else sweep.K-of-N.csv, to be
/// joined. Throws UsageError, FileError, InvalidInput for a folder that holds a sweep over another
/// grid, and what simulations throw.
///
/// With a `team` all members call this with the same job. Each process does whole runs, into a
/// folder that all members see; large runs are shared. The leader writes records and table, the
/// same as with one process, and sweep.run.json with the work of each member.
SweepSummary run(const SweepJob& job, const Reporter& reporter = {}, const RunCallback& on_run = {},
                 Team* team = nullptr);

/// Joins the records of all parts, in one folder or in several, into sweep.csv in the first folder.
/// Returns its path. Throws InvalidInput if runs are missing, saying which, or if the folders
/// belong to different sweeps.
std::filesystem::path join_sweep(const std::vector<std::filesystem::path>& folders);

}  // namespace surf::workflow
