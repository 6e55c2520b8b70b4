// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "geometry/scene_impl.h"

namespace surf::mc {

namespace {
constexpr double interface_nm = 1e-3;  // faces closer than this are one interface
constexpr int most_coinciding = 16;
constexpr double rounding_nm = 1e-7;  // of positions in double, up to millimetres from the origin
constexpr int most_silent_crossings = 1000;
}  // namespace

SceneGeometry::SceneGeometry(const Scene::Impl& scene)
    : scene_(scene), faces_may_coincide_(scene.shells.size() > 1) {
  intern({});
}

bool SceneGeometry::is_inside(State s, std::uint32_t shell) const {
  for (const std::uint32_t i : states_[static_cast<std::size_t>(s)].inside)
    if (i == shell) return true;
  return false;
}

SceneGeometry::State SceneGeometry::intern(std::vector<std::uint32_t> inside) {
  std::sort(inside.begin(), inside.end());
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (states_[i].inside == inside) return static_cast<State>(i);
  // A solid holds a point when the point is inside more outer shells than cavities.
  std::vector<std::pair<int, int>> depth;
  for (const std::uint32_t s : inside) {
    const Shell& shell = scene_.shells[s];
    const auto at = std::find_if(depth.begin(), depth.end(),
                                 [&](const auto& d) { return d.first == shell.solid; });
    if (at == depth.end()) depth.emplace_back(shell.solid, shell.sense);
    else at->second += shell.sense;
  }
  int top = -1;
  for (const auto& [solid, count] : depth)
    if (count > 0) top = std::max(top, solid);
  const int material = top < 0 ? -1 : scene_.solids[static_cast<std::size_t>(top)].material;
  states_.push_back({std::move(inside), material, {}});
  return static_cast<State>(states_.size() - 1);
}

SceneGeometry::State SceneGeometry::across(State s, std::uint32_t shell) {
  for (const auto& [known, to] : states_[static_cast<std::size_t>(s)].next)
    if (known == shell) return to;
  std::vector<std::uint32_t> inside = states_[static_cast<std::size_t>(s)].inside;
  const auto at = std::find(inside.begin(), inside.end(), shell);
  if (at == inside.end()) inside.push_back(shell);
  else inside.erase(at);
  const State to = intern(std::move(inside));
  states_[static_cast<std::size_t>(s)].next.emplace_back(shell, to);
  return to;
}

// A face counts only from the side the path is on: going in where it is outside, out where inside.
// That is what makes hits at edges, at corners and at the face just crossed harmless. A little
// behind the start, too, where rounding may have put the start beyond a face: ways out within the
// tolerance, so that nobody is shut out of a body; ways in within rounding only, or paths along a
// corner would go in again behind themselves.
bool SceneGeometry::accept(void* user, std::uint32_t triangle, double cosine, double distance) {
  auto* self = static_cast<SceneGeometry*>(user);
  const std::uint32_t shell = self->scene_.shell_of[triangle];
  const bool inward = self->goes_in(shell, cosine);
  if (inward != self->is_inside(self->asking_, shell)) return !inward || distance > -rounding_nm;
  // Well past the rounding the path should not be on this side at all.
  if (distance * std::fabs(cosine) > 2 * self->scene_.triangles->tolerance_nm())
    self->wrong_side_at_ = std::min(self->wrong_side_at_, distance);
  return false;
}

Crossing SceneGeometry::next_face(const Vec3& start, const Vec3& direction, double length,
                                  State state, const KnownFaces& faces, Face& face) {
  Crossing met = Crossing::none;
  face.distance = length;
  if (scene_.plane_nm && direction.z != 0.0) {
    const bool inside = is_inside(state, scene_.plane_shell);
    const double gap = inside ? *scene_.plane_nm - start.z : start.z - *scene_.plane_nm;
    if (gap < -interface_nm) return Crossing::wrong_side;
    const double distance = std::max(gap, 0.0) / std::fabs(direction.z);
    if (inside == (direction.z > 0) && distance <= length) {
      face.distance = distance;
      face.position = start + direction * face.distance;
      face.position.z = *scene_.plane_nm;
      face.normal = {0, 0, 1};
      face.shell = scene_.plane_shell;
      met = Crossing::surface;
    }
  }
  if (!scene_.triangles) return met;
  if (faces) {
    asking_ = state;
    wrong_side_at_ = HUGE_VAL;
    EmbreeScene::Hit hit;
    const bool found = scene_.triangles->nearest_of(*faces, start, direction, face.distance,
                                                    &SceneGeometry::accept, this, hit);
    if (!(wrong_side_at_ < (found ? hit.distance : face.distance))) {
      if (!found) return met;
      face = {hit.distance, hit.position, hit.normal, scene_.shell_of[hit.triangle]};
      return Crossing::surface;
    }
  }
  // Embree's robust mode still lets some rays through exactly at an edge. They then meet a surface
  // from behind, and the search is repeated a hair beside.
  static constexpr Vec3 nudges[] = {
      {0, 0, 0}, {0.1, 0.02, 0.05}, {-0.03, 0.1, -0.06}, {-0.08, -0.09, 0.02}};
  for (const Vec3& nudge : nudges) {
    asking_ = state;
    wrong_side_at_ = HUGE_VAL;
    EmbreeScene::Hit hit;
    const bool found =
        scene_.triangles->nearest(start, direction, face.distance, &SceneGeometry::accept, this,
                                  hit, nudge * scene_.triangles->tolerance_nm());
    if (wrong_side_at_ < (found ? hit.distance : face.distance)) continue;
    if (!found) return met;
    face = {hit.distance, hit.position, hit.normal, scene_.shell_of[hit.triangle]};
    return Crossing::surface;
  }
  return Crossing::wrong_side;
}

Crossing SceneGeometry::crossing(const Vec3& start, const Vec3& direction, double length,
                                 State& state, Surface& surface, const KnownFaces& faces) {
  Vec3 from = start;
  double done = 0;
  for (int i = 0; i < most_silent_crossings; ++i) {
    Face face;
    const Crossing met = next_face(from, direction, length - done, state, faces, face);
    if (met != Crossing::surface) return met;
    State ahead = across(state, face.shell);
    surface.distance = done + face.distance;
    surface.position = face.position;
    surface.normal = face.normal;
    if (material(ahead) != material(state) && faces_may_coincide_) {
      // The face of the neighbour on the same interface is crossed in the same breath.
      for (int k = 0; k < most_coinciding; ++k) {
        const double cosine = std::fabs(dot(face.normal, direction));
        Face next;
        if (next_face(face.position, direction, interface_nm / std::max(cosine, 1e-6), ahead, {},
                      next) != Crossing::surface)
          break;
        const double steepest = std::max(cosine, std::fabs(dot(next.normal, direction)));
        if (next.distance * steepest > interface_nm) break;
        ahead = across(ahead, next.shell);
        face = next;
      }
    }
    surface.position_ahead = face.position;
    surface.state_ahead = ahead;
    if (material(ahead) != material(state)) return Crossing::surface;
    state = ahead;
    from = face.position;
    done = dot(from - start, direction);
  }
  return Crossing::wrong_side;  // a knot of faces that leads nowhere
}

}  // namespace surf::mc
