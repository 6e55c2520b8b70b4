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
  std::vector<double> weights;  ///< of each, for progress: so many there are
  std::function<SimulateJob(std::size_t run)> make;
  /// What whoever leads has to know of a run, made by whoever did it. Null: nothing.
  std::function<std::string(std::size_t run, const SimulateJob&, const SimulateSummary&)> outcome;
  /// Told of all where the team is led, in the order in which they are finished. May be null.
  std::function<void(std::size_t run, const std::string& outcome)> finished;
  std::filesystem::path folder;  ///< that their outputs are in
  std::size_t tiles = 1;         ///< that the least of their images has
  double pixels = 1;             ///< of the largest
  bool whole = false;  ///< each by one process, so that its time means the same as without a team
  int threads = 0;

  std::string things;  ///< what weights count, for progress
  Reporter reporter;
};

struct ManyDone {
  bool complete = true;              ///< the same for all of a team; false when cancelled
  std::int64_t primaries = 0;        ///< simulated, none recalled
  double seconds = 0;                ///< sum of the wall times of all
  std::vector<MemberTally> tallies;  ///< by rank, with a team

  void add(const ManyDone& other);
};

/// Counts are the leader's. With a team each process does whole runs, but for few that are left
/// over or large ones: those are shared unit by unit. Outputs, and bytes, are those of one process.
ManyDone run_many(const ManyRuns& runs, Team* team);

/// What NAME.run.json tells of a job that a team has done: who did how much of its simulations. The
/// whole took `seconds`; primaries of whoever leads are those that nobody else has simulated.
std::string team_record(const Team& team, const ManyDone& done, double seconds, int threads,
                        const std::string& command_line);

/// The tiles of an image that one thread each can simulate.
std::size_t tiles_of(const mc::Scan& scan);

}  // namespace surf::workflow
