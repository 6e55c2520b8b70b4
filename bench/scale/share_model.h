// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace surf::scale {

/// What a unit of work costs, seconds of one processor.
struct UnitCosts {
  std::vector<double> durations_s;  ///< of units simulated alone, at least one; drawn from evenly
  double merge_s = 0;   ///< leader: merging and keeping it for the checkpoint, whoever did it
  double unpack_s = 0;  ///< leader: of somebody else's
  double pack_s = 0;    ///< who follows
  double bytes = 0;     ///< of its packed tally
};

struct Messages {
  double leader_s = 0;       ///< processor time of the leader for a message that it gets or sends
  double follower_s = 0;     ///< of who follows
  double latency_s = 0;      ///< on the way
  double bytes_per_s = 1e9;  ///< into the leader
  double shortest_nap_s = 1e-4;  ///< a side that finds no message sleeps, twice as long each time,
                                 ///< but no longer than ...
  double longest_nap_s = 5e-3;
  double looking_share = 0;  ///< of a processor of the leader's, for looking for messages
};

struct Machines {
  int ranks = 1;
  int threads = 1;  ///< of each rank, as many as it has processors
  int crowd = 1;  ///< times as many of those who follow, for tests: each takes as many times longer
};

struct Sharing {
  double seconds = 0;      ///< until the leader has merged the last unit
  double efficiency = 0;   ///< the same work on as many processors without any sharing, relative
  double leader_busy = 0;  ///< share of the time in which messages waited or were served
  double waiting_s_per_unit = 0;  ///< threads of those who follow, for units
};

/// The queue at the leader, message by message: `units` of work are handed out as
/// workflow/src/mpi_team.cpp does, two for each thread when fewer than one for each thread are in
/// hand. The leader simulates, too, and its messages take processor time from that. Above `most`
/// units, two shorter jobs tell how much longer each further unit takes.
Sharing simulate_sharing(const UnitCosts& costs, const Messages& messages, const Machines& machines,
                         std::int64_t units, std::int64_t most = 4'000'000);

/// The same from a formula: units are done at the rate of all threads or at that at which the
/// leader serves, whichever is less, and two units' time is lost at the end.
Sharing bound_sharing(const UnitCosts& costs, const Messages& messages, const Machines& machines,
                      std::int64_t units);

/// Processor time of the leader for a unit of somebody else, its share of the messages that hand
/// out units included.
double service_s(const UnitCosts& costs, const Messages& messages, int threads);

}  // namespace surf::scale
