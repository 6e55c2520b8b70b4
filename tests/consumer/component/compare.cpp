// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/align_surfaces.h"
#include "surf/compare/find_changes.h"
#include "surf/compare/surface_difference.h"

int main(int count, char**) {
  if (count > 100) {  // linked, not run
    surf::find_changes({});
    surf::surface_difference({}, {}, surf::align_surfaces({}, {}));
  }
  return surf::NoiseCorrelation{}.inflation(3) == 1 ? 0 : 1;
}
