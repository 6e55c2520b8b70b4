// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/scheduling/unit_scheduler.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// Simulates units on the threads of all processes of a team. Each process calls `mc::simulate` for
/// the same scene and options. The leader has the result.
class TeamScheduler final : public mc::UnitScheduler {
 public:
  explicit TeamScheduler(Team& team) : team_(team) {}

  bool collects() const override { return team_.leads(); }
  void run(const mc::UnitWork& work) override;
  void abandon(const std::exception_ptr& reason, const CancelToken* cancel) override;

 private:
  void lead(const mc::UnitWork& work);
  void follow(const mc::UnitWork& work);

  Team& team_;
};

}  // namespace surf::workflow
