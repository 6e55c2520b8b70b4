// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/gun.h"
#include "geometry/scene_impl.h"
#include "sampling/unit_worker.h"
#include "surf/core/random.h"
#include "surf/mc/request/simulation_options.h"
#include "transport/transport.h"

namespace surf::mc {

/// Follows primaries from collision to collision, one thread's share of them.
class DirectPrimaries {
 public:
  DirectPrimaries(const Scene::Impl& scene, const SimulationOptions& options)
      : scene_(scene), seed_(options.seed), geometry_(scene), gun_(scene.beam, scene.scan, scene.top_nm),
        detection_(options.detectors, scene.beam, options.spectra) {}

  /// The transport loop that primaries run in. With `drop_unreachable` those too far from all surfaces
  /// are given up.
  template <class Watcher>
  auto transport(Watcher& watcher, bool drop_unreachable, Balance& balance) {
    return Transport(geometry_, scene_.medium_pointers, scene_.physics.barrier, drop_unreachable, watcher,
                     detection_, balance);
  }

  /// One primary of the pixel (x, y) with this number; counted(detector, electrons) for each detector.
  /// Whether it hit.
  template <class Loop, class Counted>
  bool run(Loop& transport, int x, int y, std::uint64_t number, std::uint64_t electron,
           const Counted& counted) {
    RandomStream random(seed_, number, electron);
    const Gun::Start start = gun_.primary(x, y, random);
    const bool hit = transport.run(start.position, start.direction, scene_.beam.energy_ev, 0, random);
    for (std::size_t d = 0; d < detection_.counts().size(); ++d) counted(d, detection_.counts()[d]);
    detection_.end_primary();
    return hit;
  }

  Detection& detection() { return detection_; }

 private:
  const Scene::Impl& scene_;
  std::uint64_t seed_;
  SceneGeometry geometry_;
  Gun gun_;
  Detection detection_;
};

}  // namespace surf::mc
