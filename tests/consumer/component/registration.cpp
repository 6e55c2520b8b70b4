// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/registration/landmarks.h"
#include "surf/registration/register_images.h"

int main(int count, char**) {
  if (count > 100) surf::register_images({}, {});  // linked, not run
  const surf::LandmarkFit fit =
      surf::fit_landmarks({{{0, 0}, {1, 0}}, {{9, 0}, {10, 0}}, {{0, 9}, {1, 9}}});
  return fit.rms_nm < 1e-9 ? 0 : 1;
}
