// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/cascades/library_source.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// Libraries that the leader gets, and everybody then has: they are made once, however many
/// processes there are.
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
