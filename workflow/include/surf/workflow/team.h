// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/workflow/node_memory.h"

namespace surf::workflow {

/// What one process of a team has done, for the record.
struct TeamMember {
  int rank = 0;
  std::string host;
  int threads = 0;
  std::int64_t units = 0;  ///< of work simulated
  std::int64_t primaries = 0;
  double waiting_s = 0;         ///< of all its threads, for units
  std::int64_t bytes_sent = 0;  ///< to the leader
  std::int64_t messages = 0;    ///< sent: to the leader, or by it
  double messaging_s =
      0;  ///< processor time of the thread that talks to the others, the leader's merging included
};

/// The number of the next unit of work, or none when there is no more.
using TakeUnit = std::function<std::optional<std::size_t>()>;

/// What has become of a unit, as whoever leads and whoever follows have agreed to write it.
struct FinishedUnit {
  std::size_t number = 0;
  std::int64_t primaries = 0;  ///< simulated for it
  std::string bytes;
  int rank = 0;  ///< who did it; whoever leads is told
};
using GiveUnit = std::function<void(FinishedUnit unit)>;

/// Processes that do one job together, each of which calls the same functions in the same order.
/// Rank 0 leads: it reads and writes what all share, and talks to the user.
class Team {
 public:
  virtual ~Team() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  bool leads() const { return rank() == 0; }

  /// Hands numbered units of work to the others until there is no more to take and all that they
  /// took has been given, or until `cancel`. `take` and `give` may be called while others call
  /// them. Uses the calling thread for all messages.
  virtual void lead(const TakeUnit& take, const GiveUnit& give, const CancelToken* cancel) = 0;

  /// The other side: calls `work` with a `take` that waits for the leader, and a `give` that sends
  /// there. `work` computes on `threads` threads, and returns when `take` has no more. About
  /// `ahead` units are kept here beyond those at work, so that nobody waits for the next; 0 where a
  /// unit is long, and others may be idle by then. Throws Interrupted on `cancel`, which the leader
  /// takes for a failure unless it is cancelled itself.
  virtual void follow(const std::function<void(const TakeUnit&, const GiveUnit&)>& work,
                      int threads, int ahead, const CancelToken* cancel) = 0;

  /// From the leader to all.
  virtual void broadcast(std::string& bytes) = 0;
  /// The texts of all, by rank, for all.
  virtual std::vector<std::string> exchange(const std::string& text) = 0;
  /// What the members have done since the team began; the leader's knowledge.
  virtual std::vector<TeamMember> members() const = 0;
  /// What those on this machine share; null where there is nobody else.
  virtual NodeMemory* node() { return nullptr; }
};

/// Does a part of the work that all do, and fails on all if it fails on one: who went on alone
/// would wait for the others for ever. What failed elsewhere is told by rank. Without a team it
/// just does it.
void together(Team* team, const std::function<void()>& part);

/// Leads a team while `work` runs on a thread of its own, or after it where none can be started.
/// Where either throws, `end` is called, after which `take` must have no more, and the exception is
/// passed on when both are over.
void lead_while(Team& team, const TakeUnit& take, const GiveUnit& give, const CancelToken* cancel,
                const std::function<void()>& work, const std::function<void()>& end);

/// Whether to talk to the user and to write.
inline bool leads(const Team* team) { return !team || team->leads(); }

/// The memory that a team's processes on this machine share; null where there is nobody else.
inline NodeMemory* node_of(Team* team) { return team ? team->node() : nullptr; }

/// Does what the first process of a machine does for the others, whose answer is its text; alone
/// too. Where it fails, all fail.
std::string once_per_node(NodeMemory* node, const std::function<std::string()>& work);

}  // namespace surf::workflow
