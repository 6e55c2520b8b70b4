// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "surf/workflow/team.h"

namespace surf::workflow {

/// The number of processes that `mpirun` or `srun` has started together, from the environment (Open
/// MPI, PMIx, PMI, Slurm); 1 if this process is alone.
int processes_started();

/// Joins these processes; call it once per process. Returns null if this process is alone; then MPI
/// is not loaded. Throws Unsupported if there are others and MPI is missing: each process would do
/// the whole job and write the same files.
std::unique_ptr<Team> join_started_team();

}  // namespace surf::workflow
