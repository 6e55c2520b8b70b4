// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <cstdlib>

#include "exit_codes.h"
#include "joined_team.h"
#include "run.h"
#include "surf/core/error.h"
#include "terminal.h"

int main(int argc, char** argv) {
  using namespace surf::cli;
  // OpenBLAS comes with modules. Threads of its own are never used, and where address space is
  // short they never end.
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  try {
    join_team();
  } catch (const surf::Error& error) {
    print_error(error.what());
    return exit_unusable;
  }
  const bool follows = team() && !team()->leads();
  if (follows) be_silent();
  const int code = run({argv, argv + argc}, stdout, stderr);
  leave_team();
  return follows ? 0 : code;  // mpirun hands on the code of whoever ends first
}
