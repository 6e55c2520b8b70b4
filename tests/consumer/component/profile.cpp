// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/edge_roughness.h"
#include "surf/profile/feature_shape.h"
#include "surf/profile/fit_profile.h"

int main(int count, char**) {
  if (count > 100) {  // linked, not run
    surf::fit_roughness({}, 1, 1);
    surf::fit_profile({}, {{}, 0, 1, {}, {}}, {});
  }
  return surf::wall_extent({100, 90, 0, 0}).top_nm < 1e-9 ? 0 : 1;
}
