// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "geometry/gun.h"
#include "geometry/scene_impl.h"
#include "sampling/primaries_per_pixel.h"
#include "sampling/primary_source.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mc/request/simulation_options.h"
#include "transport/forward.h"
#include "transport/transport.h"

namespace surf::mc {

/// Primaries that are followed from collision to collision, pixel by pixel.
class DirectSource {
 public:
  static constexpr PixelModel model = PixelModel::direct;
  static constexpr bool misses_are_known = false;

  DirectSource(const Scene::Impl& scene, const SimulationOptions& options)
      : scene_(scene), seed_(options.seed), accuracy_(accuracy_of(options.budget)),
        numbers_(scene.scan, options), geometry_(scene), gun_(scene.beam, scene.scan, scene.top_nm),
        detection_(options.detectors, scene.beam, options.spectra) {}

  void begin(const SourceTask& task) {
    unit_ = task.unit;
    observer_ = task.observer;
    cancel_ = task.cancel;
    balance_ = {};
  }

  template <class Visit>
  void serve(std::span<const PrimaryRange> ranges, const Visit& visit) {
    if (observer_) {
      Forward forward{*observer_};
      serve_watched(ranges, forward, visit);
    } else {
      NoObserver nobody;
      serve_watched(ranges, nobody, visit);
    }
  }

  void finish(UnitTally& tally) {
    tally.balance += balance_;
    tally.spectra = detection_.take_spectra();
  }

  /// As many as a pixel takes where one primary in a hundred gives an electron: without a floor of
  /// the accuracy a dark one would go on for ever.
  std::uint64_t most_primaries() const {
    return static_cast<std::uint64_t>(
        std::min(std::max(1e4, 100 / (accuracy_ * accuracy_)), 2147483648.0));
  }
  bool misses(std::size_t) const { return false; }
  bool settled(std::size_t) const { return false; }
  bool controlled(std::size_t) const { return false; }
  Estimate control(std::size_t, std::size_t) const { return {}; }

 private:
  template <class Watcher, class Visit>
  void serve_watched(std::span<const PrimaryRange> ranges, Watcher& watcher, const Visit& visit) {
    // Electrons too far from all surfaces are given up where nobody sees it.
    Transport transport(geometry_, scene_.medium_pointers, scene_.physics.barrier,
                        observer_ == nullptr, watcher, detection_, balance_);
    const int width = unit_.x1 - unit_.x0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const int x = unit_.x0 + static_cast<int>(i) % width,
                y = unit_.y0 + static_cast<int>(i) / width;
      const std::uint64_t number = numbers_.number(x, y);
      for (std::uint64_t e = ranges[i].first; e < ranges[i].end; ++e) {
        if (cancel_ && cancel_->cancelled()) throw Interrupted();
        if (observer_)
          observer_->primary(static_cast<std::int64_t>(number), static_cast<std::int64_t>(e));
        RandomStream random(seed_, number, e);
        const Gun::Start start = gun_.primary(x, y, random);
        const bool hit =
            transport.run(start.position, start.direction, scene_.beam.energy_ev, 0, random);
        visit(i, e, hit,
              [&](std::size_t d) { return std::pair<int, int>(detection_.counts()[d], 0); });
        detection_.end_primary();
      }
    }
  }

  const Scene::Impl& scene_;
  std::uint64_t seed_;
  double accuracy_;
  PrimariesPerPixel numbers_;
  SceneGeometry geometry_;
  Gun gun_;
  Detection detection_;
  Balance balance_;
  WorkUnit unit_;
  Observer* observer_ = nullptr;
  const CancelToken* cancel_ = nullptr;
};

static_assert(PrimarySource<DirectSource>);

}  // namespace surf::mc
