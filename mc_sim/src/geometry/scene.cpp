// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "geometry/reach.h"
#include "geometry/scene_impl.h"
#include "surf/core/units.h"

namespace surf::mc {

namespace {

constexpr std::size_t sky_columns = 1 << 14;

// The part of the surface's box that electrons of the scan come near: the scanned region and the
// reach around it. Outside the box of all surfaces the distance to that box is bound enough.
Box near_scan(const Box& surface, const Scan& scan, const Beam& beam, double reach) {
  double half_x = 0.5 * scan.width * scan.pixel_x_nm, half_y = 0.5 * scan.height * scan.pixel_y_nm;
  if (beam.tilt_deg > 0) {
    // A tilted beam meets the surface beside the scan plane by up to its depth times tan(tilt).
    const double slope = std::tan(std::min(beam.tilt_deg, 85.0) * degrees_to_radians);
    half_x = half_y =
        std::hypot(half_x, half_y) * std::sqrt(1 + slope * slope) + surface.size_nm().z * slope;
  }
  Box box = surface;
  box.lower_nm.x = std::max(box.lower_nm.x, scan.center_x_nm - half_x - reach);
  box.lower_nm.y = std::max(box.lower_nm.y, scan.center_y_nm - half_y - reach);
  box.upper_nm.x = std::min(box.upper_nm.x, scan.center_x_nm + half_x + reach);
  box.upper_nm.y = std::min(box.upper_nm.y, scan.center_y_nm + half_y + reach);
  return box;
}

SceneSurfaces surfaces_of(const Specimen& specimen, const Beam& beam, const Scan& scan,
                          const Physics& physics, const SceneOptions& options) {
  options.watch.check();
  const std::vector<BodyFacts> facts = validate(specimen, options.watch.part(0, 0.1));
  return make_surfaces(specimen, facts, beam, scan, physics, {.watch = options.watch});
}

}  // namespace

Scene::Scene(const Specimen& specimen, const Beam& beam, const Scan& scan, const Physics& physics,
             const SceneOptions& options)
    : Scene(surfaces_of(specimen, beam, scan, physics, options), specimen.materials, beam, scan,
            physics, options) {}

Scene::Scene(SceneSurfaces surfaces, std::vector<Material> materials, const Beam& beam,
             const Scan& scan, const Physics& physics, const SceneOptions& options)
    : impl_(std::make_unique<Impl>()) {
  const auto begin = std::chrono::steady_clock::now();
  validate(beam);
  validate(scan);
  validate(physics, beam.energy_ev);
  const Watch& watch = options.watch;
  Impl& s = *impl_;
  s.beam = beam;
  s.scan = scan;
  s.physics = physics;
  s.materials = std::move(materials);
  s.media = make_media(s.materials, physics);
  for (const Medium& m : s.media) s.medium_pointers.push_back(&m);
  s.plane_nm = surfaces.plane_nm;
  s.plane_shell = 0;
  s.shells = std::move(surfaces.shells);
  s.solids = std::move(surfaces.solids);
  s.half_space = surfaces.half_space;
  const Box& box = surfaces.box;
  s.top_nm = s.plane_nm.value_or(box.empty() ? 0.0 : box.upper_nm.z);
  s.bottom_nm = box.empty() ? s.top_nm : std::min(box.lower_nm.z, s.plane_nm.value_or(HUGE_VAL));
  s.farthest_nm = 1e12;
  s.summary.triangles_left_out = surfaces.triangles_left_out;
  if (!surfaces.mesh.empty()) {
    s.top_nm = std::max(s.top_nm, box.upper_nm.z);
    const MeshView mesh = surfaces.mesh.view();
    s.shell_of = surfaces.mesh.shell_of.values;
    const Box domain = near_scan(box, scan, beam, reach_of(s.media, beam).of_any_nm);
    watch.report(0.3, 1);
    s.near = DistanceGrid(mesh, domain, options.distance_grid_bytes, 0, watch.part(0.3, 0.7));
    watch.report(0.7, 1);
    s.sky = HorizonMap(mesh, domain, sky_columns, 0, watch);
    watch.report(0.8, 1);
    s.triangles = std::make_unique<EmbreeScene>(std::move(surfaces.mesh), watch.part(0.8, 1));
  }
  s.summary.triangles = s.shell_of.size();
  s.summary.shells = s.shells.size();
  s.summary.grid_cell_nm = s.near.cell_nm();
  s.summary.memory_bytes = s.near.bytes() + s.sky.bytes() +
                           s.shell_of.size() * sizeof(std::uint32_t) +
                           (s.triangles ? s.triangles->memory_bytes() : 0);
  s.summary.build_seconds =
      surfaces.build_seconds +
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const Beam& Scene::beam() const { return impl_->beam; }
const Scan& Scene::scan() const { return impl_->scan; }
const Physics& Scene::physics() const { return impl_->physics; }
const std::vector<Material>& Scene::materials() const { return impl_->materials; }
const SceneSummary& Scene::summary() const { return impl_->summary; }

bool Scene::first_surface(const Vec3& start, const Vec3& direction, Vec3& hit) const {
  SceneGeometry geometry(*impl_);
  SceneGeometry::State state = 0;
  SceneGeometry::Surface surface;
  if (geometry.crossing(start, direction, HUGE_VAL, state, surface) != Crossing::surface)
    return false;
  hit = surface.position;
  return true;
}

double Scene::distance_bound_nm(const Vec3& point) const { return impl_->clearance_nm(point); }

}  // namespace surf::mc
