// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surf/core/vec3.h"

namespace surf::io {

/// A perspective camera in a glTF scene (y up): it looks along its own -z, its own y is up in the
/// picture.
struct GltfCamera {
  Vec3 position;
  std::array<double, 4> rotation;  ///< quaternion x, y, z, w
  double yfov;                     ///< radians
  double znear, zfar;              ///< distances of what is drawn
};

/// Looks obliquely from above at the middle of `framed`, from as near as shows all of it in a
/// picture that is at least as wide as high. Draws `all`, too, and from a hundredth to four times
/// the distance. Both in the scene's frame, not empty; `smallest` (> 0) is the distance where the
/// box has no size.
GltfCamera frame_box(const Box& framed, const Box& all, double smallest);

}  // namespace surf::io
