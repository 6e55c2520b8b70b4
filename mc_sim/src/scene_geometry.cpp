// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "scene_impl.h"

namespace surf::mc {

namespace {
constexpr double interface_nm = 1e-3;   // faces closer than this are one interface
constexpr int most_coinciding = 16;
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
// That is what makes hits at edges, at corners and at the face just crossed harmless.
bool SceneGeometry::accept(void* user, std::uint32_t triangle, double cosine, float distance) {
  auto* self = static_cast<SceneGeometry*>(user);
  const std::uint32_t shell = self->scene_.shell_of[triangle];
  if (self->goes_in(shell, cosine) != self->is_inside(self->asking_, shell)) return true;
  // Well past the rounding the path should not be on this side at all.
  const double tolerance = self->scene_.triangles->tolerance_nm();
  if ((distance - tolerance) * std::fabs(cosine) > 2 * tolerance)
    self->wrong_side_at_ = std::min(self->wrong_side_at_, static_cast<double>(distance));
  return false;
}

Crossing SceneGeometry::next_face(const Vec3& start, const Vec3& direction, double length,
                                  State state, Face& face) {
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
  if (scene_.triangles) {
    asking_ = state;
    wrong_side_at_ = HUGE_VAL;
    EmbreeScene::Hit hit;
    const bool found =
        scene_.triangles->nearest(start, direction, face.distance, &SceneGeometry::accept, this, hit);
    if (found) {
      face.distance = hit.distance;
      face.position = hit.position;
      face.normal = hit.normal;
      face.shell = scene_.shell_of[hit.triangle];
      met = Crossing::surface;
    }
    if (wrong_side_at_ < face.distance) return Crossing::wrong_side;
  }
  return met;
}

Crossing SceneGeometry::crossing(const Vec3& start, const Vec3& direction, double length,
                                 State& state, Surface& surface) {
  Vec3 from = start;
  double done = 0;
  for (;;) {
    Face face;
    const Crossing met = next_face(from, direction, length - done, state, face);
    if (met != Crossing::surface) return met;
    State ahead = across(state, face.shell);
    surface.distance = done + face.distance;
    surface.position = face.position;
    surface.normal = face.normal;
    if (material(ahead) != material(state) && faces_may_coincide_) {
      // The face of the neighbour on the same interface is crossed in the same breath.
      for (int i = 0; i < most_coinciding; ++i) {
        const double cosine = std::fabs(dot(face.normal, direction));
        Face next;
        if (next_face(face.position, direction, interface_nm / std::max(cosine, 1e-6), ahead,
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
}

}  // namespace surf::mc
