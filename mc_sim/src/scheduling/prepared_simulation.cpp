// SPDX-License-Identifier: GPL-3.0-or-later
#include "scheduling/prepared_simulation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/scene_impl.h"
#include "replay/replay_site.h"

namespace surf::mc {
namespace {

// A pilot finds a variance a little low at times.
constexpr double all_of_the_variance = 0.9;

}  // namespace

std::size_t library_size(const SimulationOptions& options, std::int64_t most_primaries,
                         std::span<const CascadeYield> yields, double of_the_variance) {
  double wanted = static_cast<double>(most_primaries) / of_the_variance;
  if (const double accuracy = accuracy_of(options.budget); accuracy > 0) {
    wanted = 4 / (accuracy * accuracy);
    for (const CascadeYield& y : yields) {
      const double error = std::max(accuracy * y.mean, floor_of(options.budget));
      if (error > 0) wanted = std::max(wanted, y.variance / (of_the_variance * error * error));
    }
  }
  const double pages =
      std::ceil(std::max({wanted, 1e4, static_cast<double>(options.least_cascades)}) /
                CascadeLibrary::page_cascades);
  return static_cast<std::size_t>(pages) * CascadeLibrary::page_cascades;
}

void PreparedSimulation::prepare(const Scene& scene, const SimulationOptions& options,
                                 LibrarySource* source, std::int64_t most_primaries,
                                 const Watch& watch) {
  scene_ = &scene.impl();
  options_ = &options;
  if (options.method == Method::direct) return;
  FreshLibraries fresh;
  if (!source) source = &fresh;
  const std::size_t least = library_size(options, most_primaries);
  get(scene, *source, least, watch);
  if (!(accuracy_of(options.budget) > 0)) return;
  measure_yields(static_cast<int>(scene.materials().size()));
  const double share =
      options.planar_control && only_planes() ? all_of_the_variance : usual_share_of_variance;
  const std::size_t wanted = std::min(library_size(options, most_primaries, yields_, share),
                                      cascades_that_fit(options.library_memory));
  if (wanted > least) get(scene, *source, wanted, watch);
  controls_.emplace(*scene_, options, libraries_, watch.cancel);
}

void PreparedSimulation::get(const Scene& scene, LibrarySource& source, std::size_t wanted,
                             const Watch& watch) {
  libraries_.clear();
  cascades_ = 0;
  for (std::size_t m = 0; m < scene.materials().size(); ++m) {
    const Medium& medium = *scene_->medium_pointers[m];
    if (!can_replay(medium)) {  // its electrons are followed directly
      libraries_.emplace_back();
      continue;
    }
    const CascadeSettings settings{scene.materials()[m], scene.physics(),
                                   scene.beam().energy_ev + medium.barrier_ev(), options_->seed};
    libraries_.push_back(source.library(settings, wanted, options_->threads, watch));
  }
  for (const auto& library : libraries_)
    if (library)
      cascades_ = cascades_ == 0 ? library->cascades() : std::min(cascades_, library->cascades());
}

std::unique_ptr<UnitWorker> PreparedSimulation::worker() {
  if (options_->method == Method::direct) return make_direct_worker(*scene_, *options_);
  return make_replay_worker(*scene_, *options_, libraries_, controls_ ? &*controls_ : nullptr);
}

std::size_t PreparedSimulation::planes_expected(int pixels) const {
  if (!controls_ || !options_->planar_control) return 0;
  SiteReplay replay(*scene_, *options_, libraries_);
  std::set<PlanarControls::Key> keys;
  const double all = static_cast<double>(scene_->scan.width) * scene_->scan.height;
  const int stride = std::max(1, static_cast<int>(std::sqrt(all / pixels)));
  for (int y = stride / 2; y < scene_->scan.height; y += stride)
    for (int x = stride / 2; x < scene_->scan.width; x += stride) {
      const ReplaySite site = replay.site(x, y, true);
      if (site.hit)
        keys.insert(controls_->key(site.material, site.flat.normal, replay.proved_plane(site)));
    }
  return std::max(keys.size(), controls_->made().planes);
}

std::size_t PreparedSimulation::library_bytes() const {
  std::size_t bytes = 0;
  for (const auto& library : libraries_)
    if (library) bytes += library->bytes();
  return bytes;
}

// On the plane where counts scatter most for their mean: the one across the beam.
void PreparedSimulation::measure_yields(int materials) {
  constexpr std::size_t pilot = 5 * CascadeLibrary::page_cascades;
  Libraries first;
  for (const auto& library : libraries_)
    first.push_back(library ? std::make_shared<CascadeLibrary>(
                                  library->first(pilot / CascadeLibrary::page_cascades))
                            : nullptr);
  PlanarControls controls(*scene_, *options_, first, nullptr);  // of some thousand cascades
  for (int m = 0; m < materials; ++m) {
    const auto match = controls.match(m, -direction(scene_->beam), false);
    for (const Counts& sums : match.control->sums) {
      const auto n = static_cast<double>(controls.cascades());
      const Estimate e = estimate(static_cast<std::int64_t>(controls.cascades()), sums);
      yields_.push_back({e.mean, e.standard_error * e.standard_error * n});
    }
  }
}

// Whether every pixel is proved to be a plane, so that nothing but the library's error is in it.
// Ends at the first that is not.
bool PreparedSimulation::only_planes() const {
  SiteReplay replay(*scene_, *options_, libraries_);
  for (int y = 0; y < scene_->scan.height; ++y)
    for (int x = 0; x < scene_->scan.width; ++x) {
      const ReplaySite site = replay.site(x, y, true);
      if (!site.single || (site.hit && !replay.proved_plane(site))) return false;
    }
  return true;
}

std::size_t PreparedSimulation::cascades_that_fit(double bytes) const {
  constexpr std::size_t page = CascadeLibrary::page_cascades;
  double of_a_page = 0;
  for (const auto& library : libraries_)
    if (library)
      of_a_page += static_cast<double>(library->bytes()) / static_cast<double>(library->pages());
  return static_cast<std::size_t>(bytes / of_a_page) * page;
}

}  // namespace surf::mc
