// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/team.h"
#include "thread_crew.h"

namespace surf::test {

/// One thread of a team.
class ThreadTeam : public workflow::Team {
 public:
  ThreadTeam(CrewRoom& room, int rank, int size)
      : room_(room), crew_(room, rank), rank_(rank), size_(size) {
    for (int r = 0; r < size; ++r) members_.push_back({r, "host", 1, 0, 0, 0, 0});
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  std::vector<workflow::TeamMember> members() const override { return members_; }

  // The kind of call goes with it: all have to do the same.
  void broadcast(std::string& bytes) override {
    bytes = meet("broadcast ", leads() ? bytes : "").front();
  }
  std::vector<std::string> exchange(const std::string& text) override {
    return meet("exchange ", text);
  }

  void lead(const workflow::TakeUnit& take, const workflow::GiveUnit& give,
            const CancelToken* cancel) override {
    const auto count = [&](workflow::FinishedUnit unit) {
      auto& member = members_[static_cast<std::size_t>(unit.rank)];
      ++member.units;
      member.primaries += unit.primaries;
      give(std::move(unit));
    };
    crew_.lead(take, count, cancel);
  }
  void follow(const std::function<void(const workflow::TakeUnit&, const workflow::GiveUnit&)>& work,
              int threads, int ahead, const CancelToken* cancel) override {
    crew_.follow(work, threads, ahead, cancel);
  }

 private:
  std::vector<std::string> meet(const std::string& kind, const std::string& text) {
    std::vector<std::string> all = room_.exchange(rank_, kind + text);
    for (std::string& one : all) {
      if (!one.starts_with(kind)) throw std::runtime_error("the others do something else");
      one.erase(0, kind.size());
    }
    return all;
  }

  CrewRoom& room_;
  ThreadCrew crew_;
  int rank_, size_;
  std::vector<workflow::TeamMember> members_;
};

/// Calls `part(team)` on a thread for each of a team, and tells what each has thrown; empty:
/// nothing.
template <class Part>
std::vector<std::string> as_team(int size, const Part& part) {
  CrewRoom room(size);
  return on_ranks(size, [&](int rank) {
    ThreadTeam team(room, rank, size);
    part(static_cast<workflow::Team&>(team));
  });
}

}  // namespace surf::test
