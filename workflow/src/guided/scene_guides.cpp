// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided/scene_guides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/core/image_rows.h"
#include "surf/mc/geometry/surface_view.h"
#include "surf/sem/shape_guides.h"

namespace surf::workflow {
namespace {

constexpr float most_materials = 10'000;

}  // namespace

std::vector<Guide> SceneGuides::of(const std::string& detector) const {
  std::vector<Guide> guides;
  const auto own = std::ranges::find(predicted, detector, &Guide::name);
  if (own != predicted.end()) guides.push_back(*own);
  else
    for (const Guide& other : predicted) guides.push_back({other.name, other.values, false});
  guides.insert(guides.end(), shape.begin(), shape.end());
  return guides;
}

SeenSurface seen_surface(const Image& view, const mc::Beam& beam, Grid<int>& region) {
  const auto channel = [&](const char* name) -> const Grid<float>& {
    return view.find(name)->values;
  };
  const Grid<float>&z = channel("z_nm"), &nx = channel("normal.x"), &ny = channel("normal.y"),
        &nz = channel("normal.z"), &material = channel("material"), &valid = channel("valid");
  const Vec3 along = direction(beam);
  const int width = z.width(), height = z.height();
  SeenSurface surface{view.pitch_x_nm,
                      view.pitch_y_nm,
                      Grid<double>(width, height, 0.0),
                      Grid<double>(width, height, 0.0),
                      Grid<std::uint8_t>(width, height, 0),
                      beam.spot_nm};
  region = Grid<int>(width, height, -1);
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (!(valid.data()[i] > 0)) continue;
    surface.seen.data()[i] = 1;
    // Along the beam: a shift of all heights makes no difference.
    surface.height_nm.data()[i] = z.data()[i] / -along.z;
    surface.cosine.data()[i] =
        -(nx.data()[i] * along.x + ny.data()[i] * along.y + nz.data()[i] * along.z);
    const float number = material.data()[i];
    if (!(number >= 0 && number <= most_materials))
      throw InvalidInput("channel material", fmt::format("a pixel is {}", number),
                         "Give the numbers of materials, from 1 on");
    region.data()[i] = static_cast<int>(std::lround(number));
  }
  return surface;
}

SceneGuides guides_of(const mc::Scene& scene, const GuideModel& model, int threads,
                      const Watch& watch) {
  SceneGuides guides;
  const SeenSurface surface =
      seen_surface(mc::surface_view(scene, threads), scene.beam(), guides.region);
  guides.shape = shape_guides(surface, threads, watch);
  guides.predicted = predicted_guides(model, surface, threads, watch);
  return guides;
}

}  // namespace surf::workflow
