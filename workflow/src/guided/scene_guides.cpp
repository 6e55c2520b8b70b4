// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided/scene_guides.h"

#include <algorithm>
#include <cmath>

#include "surf/core/image_rows.h"
#include "surf/mc/geometry/surface_view.h"
#include "surf/sem/shape_guides.h"

namespace surf::workflow {

std::vector<Guide> SceneGuides::of(const std::string& detector) const {
  std::vector<Guide> guides;
  const auto own = std::ranges::find(predicted, detector, &Guide::name);
  if (own != predicted.end()) guides.push_back(*own);
  else
    for (const Guide& other : predicted) guides.push_back({other.name, other.values, false});
  guides.insert(guides.end(), shape.begin(), shape.end());
  return guides;
}

SceneGuides guides_of(const mc::Scene& scene, const GuideModel& model, int threads,
                      const Watch& watch) {
  const mc::Scan& scan = scene.scan();
  const Image view = mc::surface_view(scene, threads);
  const auto channel = [&](const char* name) -> const Grid<float>& {
    return std::ranges::find(view.channels, name, &Channel::name)->values;
  };
  const Grid<float>&z = channel("z_nm"), &nx = channel("normal.x"), &ny = channel("normal.y"),
                    &nz = channel("normal.z"), &material = channel("material"),
                    &valid = channel("valid");
  const Vec3 beam = direction(scene.beam());
  SeenSurface surface{scan.pixel_x_nm,
                      scan.pixel_y_nm,
                      Grid<double>(scan.width, scan.height, 0.0),
                      Grid<double>(scan.width, scan.height, 0.0),
                      Grid<std::uint8_t>(scan.width, scan.height, 0),
                      scene.beam().spot_nm};
  SceneGuides guides;
  guides.region = Grid<int>(scan.width, scan.height, -1);
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (!(valid.data()[i] > 0)) continue;
    surface.seen.data()[i] = 1;
    // Along the beam: where it starts makes no difference across a scan plane.
    surface.height_nm.data()[i] = (z.data()[i] - scan.center_z_nm) / -beam.z;
    surface.cosine.data()[i] =
        -(nx.data()[i] * beam.x + ny.data()[i] * beam.y + nz.data()[i] * beam.z);
    guides.region.data()[i] = static_cast<int>(std::lround(material.data()[i]));
  }
  guides.shape = shape_guides(surface, threads, watch);
  guides.predicted = predicted_guides(model, surface, threads, watch);
  return guides;
}

}  // namespace surf::workflow
