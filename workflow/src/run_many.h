// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "share_pieces.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// Many simulations, one after another or shared by a team.
struct ManyRuns {
  std::vector<double> weights;  ///< one weight per run, for progress
  std::function<SimulateJob(std::size_t run)> make;
  /// Describes a finished run to the leader; called on the process that did the run. Null: nothing.
  std::function<std::string(std::size_t run, const SimulateJob&, const SimulateSummary&)> outcome;
  /// Called on the leader for every run, in the order in which they finish. May be null.
  std::function<void(std::size_t run, const std::string& outcome)> finished;
  std::filesystem::path folder;  ///< folder of their outputs
  std::size_t tiles = 1;         ///< tiles of the smallest image
  double pixels = 1;             ///< pixels of the largest image
  /// One process does each run, so that its time means the same as without a team.
  bool whole = false;
  int threads = 0;

  std::string things;  ///< what the weights count, for progress
  Reporter reporter;
};

struct ManyDone {
  bool complete = true;              ///< the same on all members; false if cancelled
  std::int64_t primaries = 0;        ///< simulated primaries, without recalled ones
  double seconds = 0;                ///< sum of the wall times of all runs
  std::vector<MemberTally> tallies;  ///< by rank, with a team

  void add(const ManyDone& other);
};

/// Does all runs. With a team each process does whole runs. Large runs, and a few runs that are
/// left over, are shared unit by unit. Outputs and bytes are the same as with one process. The
/// leader has the true counts.
ManyDone run_many(const ManyRuns& runs, Team* team);

/// The text of NAME.run.json for a job done by a team: the work of each member. The whole job took
/// `seconds`. The leader's primaries are those that no other member has simulated.
std::string team_record(const Team& team, const ManyDone& done, double seconds, int threads,
                        const std::string& command_line);

/// The number of tiles in an image; one thread can simulate each.
std::size_t tiles_of(const mc::Scan& scan);

}  // namespace surf::workflow
