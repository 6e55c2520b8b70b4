// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "surf/workflow/team.h"

namespace surf::workflow {

/// How many processes `mpirun` or `srun` has started together, as the environment says (Open MPI,
/// PMIx, PMI, Slurm); 1 where this one is alone.
int processes_started();

/// Joins these processes, once in the life of one; null where this one is alone, and then nothing
/// of MPI is loaded. Throws Unsupported where there are others and MPI is missing: each would do
/// the whole job and write the same files.
std::unique_ptr<Team> join_started_team();

}  // namespace surf::workflow
