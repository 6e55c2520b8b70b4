// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers_module.h"

// OpenBLAS's own, which no header of Debian's declares.
extern "C" {
void openblas_set_num_threads(int count);
int openblas_get_num_threads();
int openblas_get_parallel();
}

namespace {

constexpr surf::solvers::Solvers table{surf::solvers::ceres_minimise,
                                       surf::solvers::make_cholmod_factor, openblas_set_num_threads,
                                       openblas_get_num_threads, openblas_get_parallel};

}  // namespace

SEMSURF_MODULE(solvers, table)
