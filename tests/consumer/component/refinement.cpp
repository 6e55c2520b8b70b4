// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/refinement/fit_modes.h"
#include "surf/refinement/mesh_modes.h"

int main(int count, char**) {
  if (count > 100) {  // linked, not run
    surf::fit_modes({}, {}, {}, {});
    surf::smooth_modes({}, {});
  }
  return surf::groups_apart({}, 1).empty() ? 0 : 1;
}
