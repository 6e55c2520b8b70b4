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
  std::vector<std::string> values;  ///< of the axes, as text: "500eV"
  /// Its outputs are in the sweep's folder. Called when the run comes: not all specimens need to be
  /// in memory.
  std::function<SimulateJob()> make;
};

/// Simulations over a grid of settings (docs/many_machines.md).
struct SweepJob {
  std::filesystem::path folder;   ///< of everything that is written; made if it is not there
  std::vector<std::string> axes;  ///< names of what varies: "energy", "tilt"
  std::vector<SweepRun> runs;     ///< all of them, whichever part this is
  int part = 1, parts = 1;        ///< 1 to `parts`; part k does runs k, k + parts, k + 2 parts ...
  std::string command_line;
};

/// Its folder and its part.
void describe(ParameterVisitor& visit, SweepJob& job);

struct SweepSummary {
  bool complete = true;             ///< false when cancelled: what is done stays
  std::size_t done = 0, found = 0;  ///< runs of this part, and those of them that were there before
  std::size_t untrustworthy = 0;    ///< runs that missed their accuracy
  std::filesystem::path table;      ///< sweep.csv, or that of the part
};

/// Of a run's image.
struct SweepYield {
  std::string detector;
  double mean = 0, standard_error = 0;
};

/// Is told of each run of this process's part that is simulated now.
using RunCallback = std::function<void(std::size_t run, const std::vector<SweepYield>& yields)>;

/// Simulates what is not there yet, and writes the table: a line for each run with its values, its
/// file, and per detector the mean yield with its standard error. What a run gave is kept in
/// records/N.json of the folder; a run that was done before with the same settings by the same
/// program is not repeated. With one part the table is sweep.csv, else sweep.K-of-N.csv, to be
/// joined. Throws UsageError, FileError, InvalidInput for a folder that holds a sweep over another
/// grid, and what simulations throw.
///
/// With a `team` all of it call this with the same job: each process does whole runs, into a folder
/// that all see, or they share large ones. The leader writes records and table, which are those of
/// one process, and who did how much to sweep.run.json.
SweepSummary run(const SweepJob& job, const Reporter& reporter = {}, const RunCallback& on_run = {},
                 Team* team = nullptr);

/// Puts the records of all parts, in one folder or in several, together to sweep.csv in the first
/// of them. Returns its path. Throws InvalidInput if runs are missing, saying which, or if folders
/// are of different sweeps.
std::filesystem::path join_sweep(const std::vector<std::filesystem::path>& folders);

}  // namespace surf::workflow
