// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/units.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/triangle_tree.h"
#include "surf/reconstruction/view.h"
#include "surf/workflow/signal_detectors.h"

namespace surf::workflow {
namespace {

constexpr double step_nm = 2;                            // by which modes are moved
constexpr double step_deg = 1;                           // by which beams are tilted
constexpr double least_margin = 8, largest_margin = 40;  // nm
// All pixels of all images take their cascades from one library: what chance makes of a few would
// be wrong everywhere, in levels and effects alike.
constexpr std::size_t least_cascades = 80'000;

/// The detector that counts a signal, among `default_detectors` and the signal's own.
std::size_t detector_of(const std::string& signal) {
  return signal == "SE" ? 0 : signal == "BSE" ? 1 : 2;
}

bool is_seen(const Vec3& p) { return std::isfinite(p.x); }

using Electrons = Grid<std::int64_t>;
constexpr std::int64_t images_of_effect = 4;  // two simulations, steps to both sides
constexpr std::int64_t least_look = 8, most_times = 10;

/// What two simulations change at each pixel, per unit of a step, and their electrons.
struct Changes {
  std::vector<double> first, second;
  std::int64_t electrons = 0;
};

/// `image(by, seed, electrons)`: an image after a step. Steps go to both sides: what a wall shows
/// that leans out more is not the opposite of what one shows that leans less.
template <class Image>
Changes changes_with(const Image& image, double step, const Electrons& electrons,
                     std::uint64_t seed) {
  const auto once = [&](std::uint64_t own) {
    const RefineImage less = image(-step, own, electrons), more = image(step, own, electrons);
    std::vector<double> change;
    for (std::size_t p = 0; p < more.mean.size(); ++p)
      change.push_back((more.mean.data()[p] - less.mean.data()[p]) / (2 * step));
    return change;
  };
  Changes out{once(seed), once(seed + 1)};
  for (const std::int64_t n : electrons.data()) out.electrons += images_of_effect * n;
  return out;
}

/// Pixels that changed, and their neighbours, among those that are allowed.
Mask changed(const Changes& c, const Mask& allowed) {
  const int w = allowed.width(), h = allowed.height();
  Mask out(w, h, 0);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto p = static_cast<std::size_t>(y * w + x);
      if (c.first[p] == 0 && c.second[p] == 0) continue;
      for (int j = std::max(0, y - 1); j <= std::min(h - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(w - 1, x + 1); ++i)
          out(i, j) = allowed(i, j);
    }
  return out;
}

/// Likewise with `electrons` per image and allowed pixel on average: a first look tells where
/// images change, with common random numbers nowhere else, and the rest goes there. What changes so
/// little that the look misses it counts as nothing, which makes steps no less right, only longer.
template <class Image>
Changes changes_by(const Image& image, double step, const Mask& allowed, std::int64_t electrons,
                   std::uint64_t seed) {
  const std::int64_t look = std::min(electrons, std::max(least_look, electrons / 4));
  const auto at = [&](const Mask& mask, std::int64_t each) {
    Electrons out(mask.width(), mask.height(), 0);
    for (std::size_t p = 0; p < out.size(); ++p) out.data()[p] = mask.data()[p] != 0 ? each : 0;
    return out;
  };
  const auto count = [](const Mask& mask) {
    return std::ranges::count_if(mask.data(), [](auto m) { return m != 0; });
  };
  Changes out = changes_with(image, step, at(allowed, look), seed);
  const Mask where = changed(out, allowed);
  const std::int64_t left = (electrons - look) * count(allowed), there = count(where);
  if (left == 0 || there == 0) return out;
  const std::int64_t more = std::min(left / there, most_times * electrons);
  if (more == 0) return out;
  const Changes rest = changes_with(image, step, at(where, more), seed + 2);
  const double share = static_cast<double>(more) / static_cast<double>(look + more);
  for (std::size_t p = 0; p < out.first.size(); ++p) {
    if (where.data()[p] == 0) continue;
    out.first[p] += share * (rest.first[p] - out.first[p]);
    out.second[p] += share * (rest.second[p] - out.second[p]);
  }
  out.electrons += rest.electrons;
  return out;
}

}  // namespace

RefineImages::RefineImages(const RefineJob& job, mc::LibrarySource& libraries)
    : job_(job), libraries_(libraries) {
  const mc::Medium medium = mc::make_medium(job.material, job.physics);
  method_ = mc::can_replay(medium) ? mc::Method::replay : mc::Method::direct;
  mc::Beam own;
  own.energy_ev = job.energy_ev;
  margin_nm_ =
      std::clamp(0.5 * mc::reach_nm(medium, own) + 2 * job.spot_nm, least_margin, largest_margin);
}

double RefineImages::tilt_deg(std::size_t view, const RefinedViewState& state) const {
  return beam(view, state).tilt_deg;
}
double RefineImages::azimuth_deg(std::size_t view, const RefinedViewState& state) const {
  return beam(view, state).azimuth_deg;
}

mc::Beam RefineImages::beam(std::size_t view, const RefinedViewState& state) const {
  mc::Beam out;
  out.energy_ev = job_.energy_ev;
  out.spot_nm = job_.spot_nm;
  out.tilt_deg = of_view(job_.tilts_deg, view, 0.0);
  out.azimuth_deg = of_view(job_.azimuths_deg, view, 0.0);
  if (state.tilt_x_deg == 0 && state.tilt_y_deg == 0) return out;
  const double angle = out.azimuth_deg * degrees_to_radians;
  const double x = out.tilt_deg * std::cos(angle) + state.tilt_x_deg,
               y = out.tilt_deg * std::sin(angle) + state.tilt_y_deg;
  out.tilt_deg = std::hypot(x, y);
  out.azimuth_deg = std::atan2(y, x) / degrees_to_radians;
  return out;
}

mc::Scan RefineImages::scan(std::size_t view, const RefinedViewState& state) const {
  const PlacedImage& image = job_.images[view].image;
  const mc::Beam own = beam(view, state);
  const BeamAxes axes = beam_axes(own.tilt_deg, own.azimuth_deg);
  mc::Scan out;
  out.width = image.values.width(), out.height = image.values.height();
  out.pixel_x_nm = image.pitch_x_nm, out.pixel_y_nm = image.pitch_y_nm;
  const Vec3 middle = axes.across * (image.x_nm(0.5 * (out.width - 1)) + state.shift_x_nm) +
                      axes.up * (image.y_nm(0.5 * (out.height - 1)) + state.shift_y_nm);
  out.center_x_nm = middle.x, out.center_y_nm = middle.y;
  if (own.tilt_deg > 0) out.center_z_nm = middle.z;
  return out;
}

mc::Specimen RefineImages::specimen(const TriangleMesh& mesh) const {
  mc::Specimen out;
  out.materials = {job_.material};
  out.bodies.push_back({job_.start_file.empty() ? "mesh" : job_.start_file.string(), mesh, 0});
  if (job_.substrate_z_nm) out.substrate = mc::Substrate{0, *job_.substrate_z_nm};
  return out;
}

RefineImage RefineImages::render(const TriangleMesh& mesh, std::size_t view,
                                 const RefinedViewState& state, std::int64_t electrons,
                                 std::uint64_t seed, int threads, const Watch& watch,
                                 const Grid<std::int64_t>* pixels) const {
  const std::string signal = of_view(job_.signals, view, std::string("SE"));
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{electrons};
  options.seed = seed;
  options.threads = threads;
  options.method = method_;
  options.least_cascades = least_cascades;
  options.detectors = mc::default_detectors();
  for (const mc::Detector& own : detectors_of(signal, "`reconstruction.view_signal`"))
    options.detectors.push_back(own);
  const mc::Scan grid = scan(view, state);
  if (pixels)
    options.primaries = std::make_shared<mc::PrimaryNumbers>(
        mc::PrimaryNumbers{Grid<std::int64_t>(grid.width, grid.height, 0), *pixels});
  const mc::SimulationResult result =
      mc::simulate(mc::Scene(specimen(mesh), beam(view, state), grid, job_.physics,
                             {.distance_grid_bytes = 0}),  // built anew for each image: slower
                   options, {.watch = watch, .libraries = &libraries_});
  if (!result.complete) throw Interrupted();
  RefineImage out{Grid<double>(grid.width, grid.height), Grid<double>(grid.width, grid.height)};
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      if (pixels && (*pixels)(x, y) == 0) continue;
      const auto yield = result.yield(detector_of(signal), x, y);
      out.mean(x, y) = yield.mean;
      out.variance(x, y) = yield.standard_error * yield.standard_error;
    }
  return out;
}

Grid<Vec3> RefineImages::seen(const TriangleMesh& mesh, std::size_t view,
                              const RefinedViewState& state) const {
  const mc::Scan grid = scan(view, state);
  const mc::Beam own = beam(view, state);
  const mc::Scene scene(specimen(mesh), own, grid, job_.physics, {.distance_grid_bytes = 0});
  const BeamAxes axes = beam_axes(own.tilt_deg, own.azimuth_deg);
  const Box box = bounds(mesh);
  const double above = length(box.size_nm()) + length(box.center_nm());
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  Grid<Vec3> out(grid.width, grid.height, {nothing, nothing, nothing});
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const Vec3 start = Vec3{grid.center_x_nm, grid.center_y_nm, grid.center_z_nm} +
                         axes.across * ((x - 0.5 * (grid.width - 1)) * grid.pixel_x_nm) +
                         axes.up * ((y - 0.5 * (grid.height - 1)) * grid.pixel_y_nm) +
                         axes.against * above;
      Vec3 hit;
      if (scene.first_surface(start, -axes.against, hit)) out(x, y) = hit;
    }
  return out;
}

std::vector<bool> vertices_in_sight(const TriangleMesh& mesh, const Grid<Vec3>& seen) {
  const TriangleTree tree(mesh);
  std::vector<bool> hit(mesh.vertices_nm.size(), false);
  std::uint32_t last = 0;
  for (const Vec3& place : seen.data()) {
    if (!is_seen(place)) continue;
    last = tree.closest(place, last).triangle;
    for (const std::uint32_t corner : mesh.triangles[last]) hit[corner] = true;
  }
  std::vector<bool> out = hit;
  for (const Triangle& t : mesh.triangles)
    if (hit[t[0]] || hit[t[1]] || hit[t[2]]) out[t[0]] = out[t[1]] = out[t[2]] = true;
  return out;
}

void RefineImages::add_effects(const TriangleMesh& base, const std::vector<MeshMode>& modes,
                               const std::vector<double>& amplitudes_nm,
                               const std::vector<RefinedViewState>& states,
                               std::int64_t all_electrons, std::uint64_t seed, const Watch& watch,
                               std::vector<RefinedView>& views, std::int64_t& counted) const {
  const std::int64_t electrons = std::max<std::int64_t>(1, all_electrons / images_of_effect);
  const std::vector<std::vector<std::size_t>> groups = groups_apart(modes, 2 * margin_nm_);
  const TriangleMesh now = moved(base, modes, amplitudes_nm);
  Watch quiet;
  quiet.cancel = watch.cancel;
  std::vector<Grid<Vec3>> hits(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    hits[v] = seen(now, v, states[v]);
    views[v].effects.assign(modes.size(), {});
  }
  // The pixels that each mode may change in each view.
  const auto affected = [&](std::size_t v, std::size_t mode) {
    std::vector<std::uint32_t> out;
    const MeshMode& m = modes[mode];
    for (std::size_t p = 0; p < hits[v].size(); ++p) {
      const Vec3& hit = hits[v].data()[p];
      if (!m.is_bump() || (is_seen(hit) && length(hit - m.middle_nm) < m.reach_nm + margin_nm_))
        out.push_back(static_cast<std::uint32_t>(p));
    }
    return out;
  };
  const bool tilts = job_.tilt_error_deg > 0;
  const std::size_t per_view = groups.size() + (tilts ? 2 : 0), tasks = views.size() * per_view;
  std::mutex adding;
  parallel_for(
      tasks, job_.threads,
      [&](std::size_t task, int) {
        const std::size_t v = task / per_view, g = task % per_view;
        RefinedView& view = views[v];
        Mask allowed(view.measured.width(), view.measured.height(), 0);
        if (g >= groups.size()) {
          std::ranges::fill(allowed.data(), 1);
          ModeEffect effect;
          for (std::uint32_t p = 0; p < allowed.size(); ++p) effect.pixels.push_back(p);
          const auto turned_by = [&](double by_deg, std::uint64_t own, const Electrons& pixels) {
            RefinedViewState turned = states[v];
            (g == groups.size() ? turned.tilt_x_deg : turned.tilt_y_deg) += by_deg;
            return render(now, v, turned, electrons, own, 1, quiet, &pixels);
          };
          Changes change = changes_by(turned_by, step_deg, allowed, electrons, seed);
          effect.first = std::move(change.first), effect.second = std::move(change.second);
          (g == groups.size() ? view.tilt_x : view.tilt_y) = std::move(effect);
          return;
        }
        for (const std::size_t mode : groups[g]) {
          view.effects[mode].pixels = affected(v, mode);
          for (const std::uint32_t p : view.effects[mode].pixels) allowed.data()[p] = 1;
        }
        if (std::ranges::none_of(allowed.data(), [](auto a) { return a != 0; }))
          return;  // this view does not see these
        const auto moved_by = [&](double by_nm, std::uint64_t own, const Electrons& pixels) {
          std::vector<double> amplitudes = amplitudes_nm;
          for (const std::size_t mode : groups[g]) amplitudes[mode] += by_nm;
          return render(moved(base, modes, amplitudes), v, states[v], electrons, own, 1, quiet,
                        &pixels);
        };
        const Changes change = changes_by(moved_by, step_nm, allowed, electrons, seed);
        for (const std::size_t mode : groups[g]) {
          ModeEffect& effect = view.effects[mode];
          for (const std::uint32_t p : effect.pixels) {
            effect.first.push_back(change.first[p]);
            effect.second.push_back(change.second[p]);
          }
        }
        const std::lock_guard lock(adding);
        counted += change.electrons;
      },
      watch);
}

}  // namespace surf::workflow
