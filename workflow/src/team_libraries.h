// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/cascades/library_source.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// Libraries that the leader gets and sends to all members: each is made once, for any number of
/// processes.
class TeamLibraries : public mc::LibrarySource {
 public:
  /// `own` serves the leader.
  TeamLibraries(Team& team, mc::LibrarySource& own) : team_(team), own_(own) {}

  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t cascades, int threads,
                                                    const Watch& watch) override;

 private:
  Team& team_;
  mc::LibrarySource& own_;
};

}  // namespace surf::workflow
