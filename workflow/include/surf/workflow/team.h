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

/// The work of one process of a team, for the record.
struct TeamMember {
  int rank = 0;
  std::string host;
  int threads = 0;
  std::int64_t units = 0;  ///< units of work simulated
  std::int64_t primaries = 0;
  double waiting_s = 0;         ///< time that all its threads waited for units
  std::int64_t bytes_sent = 0;  ///< to the leader
  std::int64_t messages = 0;    ///< messages sent to the leader, or by it
  /// Processor time of the thread that exchanges messages, including the leader's merging.
  double messaging_s = 0;
};

/// Returns the number of the next unit of work, or nothing if there are no more.
using TakeUnit = std::function<std::optional<std::size_t>()>;

/// A finished unit of work, serialized in a format on which leader and followers agree.
struct FinishedUnit {
  std::size_t number = 0;
  std::int64_t primaries = 0;  ///< primaries simulated for it
  std::string bytes;
  int rank = 0;  ///< the process that did it; known to the leader
};
using GiveUnit = std::function<void(FinishedUnit unit)>;

/// Processes that do one job together. Each of them calls the same functions in the same order. The
/// leader, rank 0, reads and writes the shared state and talks to the user.
class Team {
 public:
  virtual ~Team() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  bool leads() const { return rank() == 0; }

  /// Leads: hands numbered units of work to the followers until `take` has no more and all units
  /// taken have been given back, or until `cancel`. `take` and `give` must allow calls from other
  /// threads at the same time. The calling thread handles all messages.
  virtual void lead(const TakeUnit& take, const GiveUnit& give, const CancelToken* cancel) = 0;

  /// Follows: calls `work` with a `take` that waits for the leader, and a `give` that sends to the
  /// leader. `work` computes on `threads` threads, and returns when `take` has no more. About
  /// `ahead` units are queued here besides those at work, so that no thread waits for the next
  /// unit. Use 0 if units are long, because other processes may run out of work meanwhile. Throws
  /// Interrupted on `cancel`, which the leader treats as a failure unless it is cancelled itself.
  virtual void follow(const std::function<void(const TakeUnit&, const GiveUnit&)>& work,
                      int threads, int ahead, const CancelToken* cancel) = 0;

  /// Sends `bytes` from the leader to all members.
  virtual void broadcast(std::string& bytes) = 0;
  /// Sends the text of each member to all members. Returns the texts by rank.
  virtual std::vector<std::string> exchange(const std::string& text) = 0;
  /// The work of the members since the team began; known to the leader.
  virtual std::vector<TeamMember> members() const = 0;
  /// The memory shared by the members on this machine; null if there is only one.
  virtual NodeMemory* node() { return nullptr; }
};

/// Runs a part of the work that every member does, and fails on all members if it fails on one.
/// Otherwise a member that went on alone would wait for the others forever. Failures elsewhere are
/// reported by rank. Without a team it just runs the part.
void together(Team* team, const std::function<void()>& part);

/// Leads a team while `work` runs on a thread of its own, or afterwards if no thread can be
/// started. If either throws, `end` is called, after which `take` must return nothing. The
/// exception is rethrown when both are over.
void lead_while(Team& team, const TakeUnit& take, const GiveUnit& give, const CancelToken* cancel,
                const std::function<void()>& work, const std::function<void()>& end);

/// Whether this process talks to the user and writes files.
inline bool leads(const Team* team) { return !team || team->leads(); }

/// The memory that the team's processes on this machine share; null if there is only one.
inline NodeMemory* node_of(Team* team) { return team ? team->node() : nullptr; }

/// Runs `work` on the first process of each machine, and returns its text on all processes of the
/// machine. A process without others runs it itself. If it fails, it fails on all.
std::string once_per_node(NodeMemory* node, const std::function<std::string()>& work);

}  // namespace surf::workflow
