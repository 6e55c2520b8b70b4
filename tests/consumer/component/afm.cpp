// SPDX-License-Identifier: GPL-3.0-or-later
// Takes a round tip off a scan of a step.
#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"

int main() {
  surf::HeightField scan;
  scan.z_nm = surf::Grid<double>(32, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 16; x < 32; ++x) scan.z_nm(x, y) = 20;
  const surf::HeightField surface = surf::erode(scan, surf::hemisphere_tip(5, 1, 1, 9, 9));
  return surface.z_nm(0, 0) == 0 && surface.z_nm(31, 31) == 20 ? 0 : 1;
}
