// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/replay_site.h"

#include <algorithm>
#include <cmath>

namespace surf::mc {

static_assert(Geometry<SceneGeometry> && WalkHandler<Replay<SceneGeometry>>);

namespace {

// Surfaces are no better known than this; what deviates less from a plane is a plane.
constexpr double plane_nm = 1e-6;

// Pixels that share a patch: their surfaces are no farther apart and no more turned than this. A
// patch of its own costs a pixel of 10 nm more than its electrons do, so that wide pixels share as
// well, two by two.
constexpr double least_shared_nm = 12, most_shared_nm = 24, shared_px = 2.4, shared_cosine = 0.9;
constexpr int most_shared = 8;  // pixels along a block
constexpr std::size_t most_patches = 512;

bool any_origin(const std::vector<Detector>& detectors) {
  return std::any_of(detectors.begin(), detectors.end(),
                     [](const Detector& d) { return d.origin != Origin::any; });
}

std::vector<const CascadeLibrary*> pointers(const Libraries& libraries) {
  std::vector<const CascadeLibrary*> out;
  for (const auto& l : libraries) out.push_back(l.get());
  return out;
}

}  // namespace

SiteReplay::SiteReplay(const Scene::Impl& scene, const SimulationOptions& options,
                       const Libraries& libraries)
    : scene_(scene), libraries_(libraries), geometry_(scene),
      gun_(scene.beam, scene.scan, scene.top_nm),
      detection_(options.detectors, scene.beam, options.spectra),
      direct_(geometry_, scene.medium_pointers, scene.physics.barrier, true, nobody_, detection_,
              balance_),
      replay_(geometry_, scene.medium_pointers, pointers(libraries), scene.physics.barrier,
              any_origin(options.detectors), direct_, detection_, balance_) {
  const double pixel_nm = std::max({scene.scan.pixel_x_nm, scene.scan.pixel_y_nm, 1e-6});
  shared_nm_ = std::clamp(shared_px * pixel_nm, least_shared_nm, most_shared_nm);
  block_ = std::clamp(static_cast<int>(shared_nm_ / pixel_nm), 1, most_shared);
  replay_.use_common_random_numbers(accuracy_of(options.budget) > 0 && options.planar_control);
}

ReplaySite SiteReplay::site(int x, int y, bool look_around) {
  ReplaySite site = site_alone(x, y);
  if (!site.hit || !look_around) return site;
  if (site.before == 0) find_plane(site);
  if (!site.flat.whole && scene_.triangles) site.patch = patch(x, y, site);
  return site;
}

// What the beam meets first.
ReplaySite SiteReplay::site_alone(int x, int y) {
  ReplaySite site;
  site.middle = gun_.middle(x, y);
  site.single = scene_.beam.spot_nm == 0 && scene_.beam.convergence_deg == 0;
  const Crossing met = geometry_.crossing(site.middle.position, site.middle.direction, HUGE_VAL,
                                          site.before, site.surface);
  site.hit = met == Crossing::surface;
  if (!site.hit) return site;
  site.material = geometry_.material(site.surface.state_ahead);
  const Vec3& n = site.surface.normal;
  site.flat = {site.surface.position,
               dot(n, site.middle.direction) > 0 ? -n : n,
               0,
               false,
               site.surface.state_ahead,
               site.before};
  return site;
}

// Neighbours share a patch: that of the pixel in the middle of their block, where the surface there
// is near enough and about as steep. Which one a pixel gets depends on the scan alone, as the
// frame's rounding may decide an electron's fate.
std::shared_ptr<const LocalSurface> SiteReplay::patch(int x, int y, const ReplaySite& site) {
  const auto own = [&](const ReplaySite& s) {
    return std::make_shared<const LocalSurface>(*scene_.triangles, scene_.plane_nm,
                                                s.surface.position, s.flat.normal);
  };
  if (patches_.size() > most_patches) patches_.clear();
  const auto [at, is_new] = patches_.try_emplace({x / block_, y / block_});
  if (is_new) {
    const ReplaySite middle =
        site_alone(std::min(x / block_ * block_ + block_ / 2, scene_.scan.width - 1),
                   std::min(y / block_ * block_ + block_ / 2, scene_.scan.height - 1));
    if (middle.hit) at->second = {middle.flat.normal, own(middle)};
  }
  const BlockSurface& block = at->second;
  const bool near = block.patch && dot(block.normal, site.flat.normal) > shared_cosine &&
                    length(block.patch->frame().origin - site.surface.position) < shared_nm_;
  return near ? block.patch : own(site);
}

double SiteReplay::range_nm(int material) const {
  if (const CascadeLibrary* const l = library(material)) return l->reach_nm();
  const Medium& medium = *scene_.medium_pointers[static_cast<std::size_t>(material)];
  return medium.range_nm(scene_.beam.energy_ev + medium.barrier_ev());
}

// Finds the ball around the site in which all surface is one plane, and of one shell.
void SiteReplay::find_plane(ReplaySite& site) const {
  FlatSurroundings<SceneGeometry::State>& flat = site.flat;
  const double most = range_nm(site.material);
  flat.radius = most;
  bool on_substrate = false;
  if (scene_.plane_nm) {
    const double gap = std::fabs(flat.point.z - *scene_.plane_nm);
    on_substrate = gap < plane_nm && flat.normal.z > 1 - 1e-15;
    if (!on_substrate) flat.radius = std::min(flat.radius, gap);
  }
  if (!scene_.triangles) {
    flat.radius = on_substrate ? HUGE_VAL : 0;
  } else {
    // A plane of triangles right on the substrate's would be two shells in one.
    flat.radius = scene_.triangles->flat_radius(flat.point, on_substrate ? Vec3{} : flat.normal,
                                                plane_nm, flat.radius, scene_.shell_of);
  }
  flat.whole = flat.radius >= most;
}

bool SiteReplay::proved_plane(const ReplaySite& site) {
  if (!site.single || !site.flat.whole || scene_.beam.working_distance_nm > 0) return false;
  if (!scene_.triangles) return true;
  // Whoever leaves must not come back: nothing may stand above the plane.
  const Vec3& n = site.flat.normal;
  const double offset = dot(n, site.flat.point);
  for (const KnownPlane& p : planes_)
    if (std::fabs(p.offset - offset) < plane_nm && length(p.normal - n) < 1e-12) return p.top;
  const bool top = scene_.triangles->highest_along(n) < offset + plane_nm &&
                   (!scene_.plane_nm || (n.z > 1 - 1e-15 && *scene_.plane_nm < offset + plane_nm));
  if (planes_.size() < 64) planes_.push_back({n, offset, top});
  return top;
}

bool SiteReplay::run(const ReplaySite& site, const Gun::Start& start,
                     const ReplayedPrimary& primary) {
  const double energy = scene_.beam.energy_ev;
  if (!site.single) return replay_.run(start.position, start.direction, energy, 0, primary);
  if (!site.hit) {
    ++balance_.incident;
    ++balance_.missed;
    ++balance_.transmitted;
    balance_.incident_energy.add(energy);
    balance_.escaped_energy.add(energy);
    return false;
  }
  replay_.run_from(site.surface, site.middle.direction, energy, site.before, primary);
  return true;
}

}  // namespace surf::mc
