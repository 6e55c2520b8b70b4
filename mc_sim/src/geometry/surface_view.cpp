// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/surface_view.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "geometry/gun.h"
#include "geometry/scene_impl.h"
#include "surf/core/error.h"
#include "surf/core/large_grid.h"
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

constexpr std::array<std::array<const char*, 2>, 6> all_channels{{{"z_nm", "nm"},
                                                                  {"normal.x", "1"},
                                                                  {"normal.y", "1"},
                                                                  {"normal.z", "1"},
                                                                  {"material", "1"},
                                                                  {"valid", "1"}}};

std::array<double, 6> values_of(const Seen& seen) {
  return {seen.z_nm,     seen.normal.x,       seen.normal.y,
          seen.normal.z, seen.material + 1.0, seen.anything ? 1.0 : 0.0};
}

std::size_t number_of(const std::string& name) {
  for (std::size_t i = 0; i < all_channels.size(); ++i)
    if (name == all_channels[i][0]) return i;
  throw UsageError("channels", "nothing seen of a surface is called '" + name + "'",
                   "Choose among z_nm, normal.x, normal.y, normal.z, material and valid");
}

}  // namespace

ImageRows surface_view_rows(const Scene& scene, const std::vector<std::string>& channels,
                            int threads, const std::string& scratch_folder) {
  const Scan& scan = scene.scan();
  const Scene::Impl& impl = scene.impl();
  const Gun gun(scene.beam(), scan, impl.top_nm);
  std::vector<std::size_t> wanted;
  for (const std::string& name : channels) wanted.push_back(number_of(name));
  const auto seen_of = std::make_shared<std::vector<LargeGrid<float>>>();
  for (std::size_t c = 0; c < wanted.size(); ++c)
    seen_of->emplace_back(scan.width, scan.height, scratch_folder);

  constexpr int rows_between_releases = 256;
  const int workers = resolve_threads(threads);
  std::vector<std::unique_ptr<SceneGeometry>> geometries(static_cast<std::size_t>(workers));
  for (int first = 0; first < scan.height; first += rows_between_releases) {
    const int count = std::min(rows_between_releases, scan.height - first);
    parallel_for(static_cast<std::size_t>(count), workers, [&](std::size_t row, int w) {
      auto& geometry = geometries[static_cast<std::size_t>(w)];
      if (!geometry) geometry = std::make_unique<SceneGeometry>(impl);
      const int y = first + static_cast<int>(row);
      for (int x = 0; x < scan.width; ++x) {
        const auto values = values_of(look(*geometry, gun.middle(x, y)));
        for (std::size_t c = 0; c < wanted.size(); ++c)
          (*seen_of)[c](x, y) = static_cast<float>(values[wanted[c]]);
      }
    });
    for (const auto& grid : *seen_of) grid.release();
  }

  ImageRows rows;
  rows.width = scan.width;
  rows.height = scan.height;
  rows.head.pitch_x_nm = scan.pixel_x_nm;
  rows.head.pitch_y_nm = scan.pixel_y_nm;
  rows.head.origin_x_nm = scan.center_x_nm - 0.5 * (scan.width - 1) * scan.pixel_x_nm;
  rows.head.origin_y_nm = scan.center_y_nm - 0.5 * (scan.height - 1) * scan.pixel_y_nm;
  for (const std::size_t c : wanted)
    rows.head.channels.push_back({all_channels[c][0], all_channels[c][1], {}});
  rows.read = [seen_of](std::size_t channel, int y, std::span<float> row) {
    const LargeGrid<float>& grid = (*seen_of)[channel];
    std::ranges::copy(grid.data().subspan(static_cast<std::size_t>(y) * row.size(), row.size()),
                      row.begin());
    if (y % rows_between_releases == 0) grid.release();
  };
  return rows;
}

Image surface_view(const Scene& scene, int threads) {
  std::vector<std::string> names;
  for (const auto& channel : all_channels) names.push_back(channel[0]);
  return to_image(surface_view_rows(scene, names, threads, {}));
}

}  // namespace surf::mc
