// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/affine.h"

namespace surf {

/// The same place in both images.
struct LandmarkPair {
  Point2 sem_nm, afm_nm;
};

}  // namespace surf
