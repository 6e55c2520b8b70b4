// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_view.h"

namespace surf::io {

SceneView view_of(const SurfaceScene& scene) {
  SceneView view;
  for (const Surface& surface : scene.surfaces) {
    view.surfaces.push_back(
        {surface.name, &surface.mesh, surface.scalars, surface.drape ? &*surface.drape : nullptr});
  }
  view.tracks = scene.tracks;
  view.note.metadata = scene.metadata;
  return view;
}

std::vector<std::vector<const VertexScalar*>> common_scalars(const SceneView& scene) {
  std::vector<std::vector<const VertexScalar*>> common;
  for (const VertexScalar& first : scene.surfaces.front().scalars) {
    std::vector<const VertexScalar*> found;
    for (const SurfaceView& surface : scene.surfaces) {
      for (const VertexScalar& scalar : surface.scalars) {
        if (scalar.name == first.name && scalar.unit == first.unit) found.push_back(&scalar);
      }
    }
    if (found.size() == scene.surfaces.size()) common.push_back(std::move(found));
  }
  return common;
}

}  // namespace surf::io
