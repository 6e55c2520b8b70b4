// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "forward.h"
#include "gun.h"
#include "scene_impl.h"
#include "unit_worker.h"

namespace surf::mc {

namespace {

class DirectWorker : public UnitWorker {
 public:
  DirectWorker(const Scene::Impl& scene, const SimulationOptions& options)
      : scene_(scene), options_(options), share_(scene.scan, options), geometry_(scene),
        gun_(scene.beam, scene.scan, scene.top_nm),
        detection_(options.detectors, scene.beam, options.spectra) {}

  void simulate(const WorkUnit& unit, Observer* observer, UnitTally& out) override {
    if (observer) {
      Forward forward{*observer};
      run(unit, forward, observer, out);
    } else {
      NoObserver nobody;
      run(unit, nobody, nullptr, out);
    }
  }

 private:
  template <class Watcher>
  void run(const WorkUnit& unit, Watcher& watcher, Observer* observer, UnitTally& out) {
    clear(out, unit, options_.detectors.size());
    Transport transport(geometry_, scene_.medium_pointers, scene_.physics.barrier,
                        observer == nullptr, watcher, detection_, out.balance);
    for (int y = unit.y0; y < unit.y1; ++y) {
      for (int x = unit.x0; x < unit.x1; ++x) {
        PixelTally& pixel = out.pixels(x - unit.x0, y - unit.y0);
        pixel.model = PixelModel::direct;
        const std::uint64_t number = share_.number(x, y);
        const std::int64_t end = std::min(share_.of(x, y), unit.first_electron + unit.electrons);
        for (std::int64_t e = unit.first_electron; e < end; ++e) {
          check();
          RandomStream random(options_.seed, number, static_cast<std::uint64_t>(e));
          if (observer) observer->primary(static_cast<std::int64_t>(number), e);
          const Gun::Start start = gun_.primary(x, y, random);
          const bool hit = transport.run(start.position, start.direction, scene_.beam.energy_ev, 0,
                                         random);
          ++pixel.primaries;
          pixel.hits += hit ? 1 : 0;
          for (std::size_t d = 0; d < out.counts.size(); ++d)
            out.counts[d](x - unit.x0, y - unit.y0).add(detection_.counts()[d]);
          detection_.end_primary();
        }
      }
    }
    out.spectra = detection_.take_spectra();
  }

  const Scene::Impl& scene_;
  const SimulationOptions& options_;
  Share share_;
  SceneGeometry geometry_;
  Gun gun_;
  Detection detection_;
};

}  // namespace

std::unique_ptr<UnitWorker> make_direct_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options) {
  return std::make_unique<DirectWorker>(scene, options);
}

}  // namespace surf::mc
