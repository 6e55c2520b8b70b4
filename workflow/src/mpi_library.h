// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "surf/core/module.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// The function table of the module `mpi`.
struct MpiLibrary {
  static constexpr ModuleName module{"mpi", "shares a job between processes",
                                     "MPI (Debian: libopenmpi3)", 300, "semsurf-mpi"};
  std::unique_ptr<Team> (*join)();
};

}  // namespace surf::workflow
