// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/join_team.h"

#include <cstdlib>

#include "mpi_library.h"
#include "surf/core/error.h"

namespace surf::workflow {

int processes_started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE"})
    if (const char* value = std::getenv(name)) return std::atoi(value);
  // Slurm also sets SLURM_NTASKS for programs without MPI: with one task this process is alone.
  if (std::getenv("PMIX_RANK") || std::getenv("PMI_RANK"))
    if (const char* value = std::getenv("SLURM_NTASKS")) return std::atoi(value);
  return 1;
}

std::unique_ptr<Team> join_started_team() {
  if (processes_started() < 2) return nullptr;
  try {
    return module<MpiLibrary>().join();
  } catch (const Unsupported& error) {
    throw Unsupported("mpirun", error.reason(),
                      error.remedy() + ", or start it once, without mpirun");
  }
}

}  // namespace surf::workflow
