// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/workflow/team.h"

namespace surf::cli {

/// Joins the processes that `mpirun` or `srun` has started together; nothing of MPI is touched
/// where this one was started alone. Called once, by main. Throws Unsupported if there are several
/// and MPI is missing.
void join_team();

/// The team, or null where there is none.
workflow::Team* team();

/// For work that is not shared: whether it is for another process to do. The leader says that it is
/// alone with it.
bool leave_to_leader(const std::string& command);

/// How many of the team are on this machine, itself included.
int processes_here();

/// Ends MPI, or the whole job where others can no longer be heard.
void leave_team();

}  // namespace surf::cli
