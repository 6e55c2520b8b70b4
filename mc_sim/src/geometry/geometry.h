// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>

#include "surf/core/vec3.h"

namespace surf::mc {

/// What a path met.
enum class Crossing { none, surface, wrong_side };

/// What electrons move in, for one thread: a scene, a half space, an endless medium or a user's own
/// boundary function.
///
///   State                       which bodies a point is in; a small value
///   Surface                     a place where the material changes: distance, position,
///   position_ahead, normal, state_ahead material(state)             -1: vacuum clearance(point)
///   lower bound of the distance to the nearest surface, nm crossing(start, direction, length,
///   state, surface)
///                               the first place along the path where the material changes; the
///                               state follows silent crossings (into a body inside another of the
///                               same material)
///   farthest()                  no path inside matter is this long, nm
///   flies_free(point, direction)  true only where a ray through vacuum meets nothing
template <class G>
concept Geometry = requires(G geometry, const G& known, typename G::State state,
                            typename G::Surface surface, const Vec3& v, double length) {
  { known.material(state) } -> std::convertible_to<int>;
  { known.clearance(v) } -> std::convertible_to<double>;
  { geometry.crossing(v, v, length, state, surface) } -> std::same_as<Crossing>;
  { known.farthest() } -> std::convertible_to<double>;
  { known.flies_free(v, v) } -> std::convertible_to<bool>;
  { surface.distance } -> std::convertible_to<double>;
  { surface.position } -> std::convertible_to<Vec3>;
  { surface.position_ahead } -> std::convertible_to<Vec3>;
  { surface.normal } -> std::convertible_to<Vec3>;
  { surface.state_ahead } -> std::convertible_to<typename G::State>;
};

}  // namespace surf::mc
