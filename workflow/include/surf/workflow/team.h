// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "surf/mc/scheduling/unit_scheduler.h"
#include "surf/mc/geometry/shared_memory.h"

namespace surf::workflow {

/// What one process of a team has done, for the record.
struct TeamMember {
  int rank = 0;
  std::string host;
  int threads = 0;
  std::int64_t units = 0;        ///< of work simulated
  std::int64_t primaries = 0;
  double waiting_s = 0;          ///< of all its threads, for units
  std::int64_t bytes_sent = 0;   ///< to the leader
  std::int64_t messages = 0;     ///< sent: to the leader, or by it
  double messaging_s = 0;        ///< processor time of the thread that talks to the others, the leader's merging included
};

/// Processes that do one job together, each of which calls the same functions in the same order. Rank 0 leads: it
/// reads and writes what all share, and talks to the user.
class Team : public mc::UnitScheduler {
 public:
  virtual int rank() const = 0;
  virtual int size() const = 0;
  bool leads() const override { return rank() == 0; }

  /// From the leader to all.
  virtual void broadcast(std::string& bytes) = 0;
  /// The texts of all, by rank, for all.
  virtual std::vector<std::string> exchange(const std::string& text) = 0;
  /// What the members have done since the team began; the leader's knowledge.
  virtual std::vector<TeamMember> members() const = 0;
  /// What those on this machine share; null where there is nobody else.
  virtual mc::NodeMemory* node() { return nullptr; }
};

/// Does a part of the work that all do, and fails on all if it fails on one: who went on alone would wait for the others
/// for ever. What failed elsewhere is told by rank. Without a team it just does it.
void together(Team* team, const std::function<void()>& part);

/// Whether to talk to the user and to write.
inline bool leads(const Team* team) { return !team || team->leads(); }

/// The memory that a team's processes on this machine share; null where there is nobody else.
inline mc::NodeMemory* node_of(Team* team) { return team ? team->node() : nullptr; }

/// Does what the first process of a machine does for the others, whose answer is its text; alone too.
/// Where it fails, all fail.
std::string once_per_node(mc::NodeMemory* node, const std::function<std::string()>& work);

}  // namespace surf::workflow
