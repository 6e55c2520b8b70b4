// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/surface_view.h"

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "gun.h"
#include "scene_impl.h"
#include "surf/core/parallel.h"

namespace surf::mc {

namespace {

struct Seen {
  bool anything = false;
  double z_nm = 0;
  Vec3 normal;
  int material = -1;
};

Seen look(SceneGeometry& geometry, const Gun::Start& beam) {
  SceneGeometry::State state = 0;
  SceneGeometry::Surface surface;
  if (geometry.crossing(beam.position, beam.direction, std::numeric_limits<double>::infinity(),
                        state, surface) != Crossing::surface)
    return {};
  // The beam comes from outside, so the normal that points out of the solid points against it.
  const Vec3 out = dot(surface.normal, beam.direction) > 0 ? -surface.normal : surface.normal;
  return {true, surface.position.z, out, geometry.material(surface.state_ahead)};
}

}  // namespace

Image surface_view(const Scene& scene, int threads) {
  const Scan& scan = scene.scan();
  const Scene::Impl& impl = scene.impl();
  const Gun gun(scene.beam(), scan, impl.top_nm);

  Image image;
  image.pitch_x_nm = scan.pixel_x_nm;
  image.pitch_y_nm = scan.pixel_y_nm;
  image.origin_x_nm = scan.center_x_nm - 0.5 * (scan.width - 1) * scan.pixel_x_nm;
  image.origin_y_nm = scan.center_y_nm - 0.5 * (scan.height - 1) * scan.pixel_y_nm;
  constexpr std::array<std::array<const char*, 2>, 6> channels{{{"z_nm", "nm"}, {"normal.x", "1"},
                                                                {"normal.y", "1"}, {"normal.z", "1"},
                                                                {"material", "1"}, {"valid", "1"}}};
  for (const auto& [name, unit] : channels)
    image.channels.push_back({name, unit, Grid<float>(scan.width, scan.height)});

  const int workers = resolve_threads(threads);
  std::vector<std::unique_ptr<SceneGeometry>> geometries(static_cast<std::size_t>(workers));
  parallel_for(static_cast<std::size_t>(scan.height), workers, [&](std::size_t row, int w) {
    auto& geometry = geometries[static_cast<std::size_t>(w)];
    if (!geometry) geometry = std::make_unique<SceneGeometry>(impl);
    const int y = static_cast<int>(row);
    for (int x = 0; x < scan.width; ++x) {
      const Seen seen = look(*geometry, gun.middle(x, y));
      const std::array<double, 6> values{seen.z_nm, seen.normal.x, seen.normal.y, seen.normal.z,
                                         seen.material + 1.0, seen.anything ? 1.0 : 0.0};
      for (std::size_t c = 0; c < values.size(); ++c)
        image.channels[c].values(x, y) = static_cast<float>(values[c]);
    }
  });
  return image;
}

}  // namespace surf::mc
