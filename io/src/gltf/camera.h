// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surf/core/vec3.h"

namespace surf::io {

/// A perspective camera in a glTF scene (y up). It looks along its own -z; its own y is up in the
/// picture.
struct GltfCamera {
  Vec3 position;
  std::array<double, 4> rotation;  ///< quaternion x, y, z, w
  double yfov;                     ///< radians
  double znear, zfar;              ///< nearest and farthest distance that is drawn
};

/// Makes a camera that looks obliquely from above at the middle of `framed`. Its distance is the
/// smallest that shows all of `framed` in a picture that is at least as wide as high. It draws all
/// of `all`, and everything from a hundredth to four times its distance. Both boxes are in the
/// scene's frame and not empty. `smallest` (> 0) is the distance for a box without size.
GltfCamera frame_box(const Box& framed, const Box& all, double smallest);

}  // namespace surf::io
