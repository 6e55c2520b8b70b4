// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/fit_facet_network.h"
#include "surf/sem/sem_noise.h"

int main(int count, char**) {
  if (count > 100) surf::fit_facet_network({}, {});  // linked, not run
  return 0;
}
