// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "sampling/direct_primaries.h"
#include "sampling/primaries_per_pixel.h"
#include "sampling/unit_worker.h"
#include "transport/forward.h"

namespace surf::mc {

namespace {

class DirectWorker : public UnitWorker {
 public:
  DirectWorker(const Scene::Impl& scene, const SimulationOptions& options)
      : detectors_(options.detectors.size()), primaries_per_pixel_(scene.scan, options), primaries_(scene, options) {}

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
    clear(out, unit, detectors_);
    auto transport = primaries_.transport(watcher, observer == nullptr, out.balance);
    for (int y = unit.y0; y < unit.y1; ++y) {
      for (int x = unit.x0; x < unit.x1; ++x) {
        PixelTally& pixel = out.pixels(x - unit.x0, y - unit.y0);
        pixel.model = PixelModel::direct;
        const std::uint64_t number = primaries_per_pixel_.number(x, y);
        const std::int64_t end = std::min(primaries_per_pixel_.of(x, y), unit.first_electron + unit.electrons);
        for (std::int64_t e = unit.first_electron; e < end; ++e) {
          check();
          if (observer) observer->primary(static_cast<std::int64_t>(number), e);
          const bool hit = primaries_.run(
              transport, x, y, number, static_cast<std::uint64_t>(e),
              [&](std::size_t d, int counted) { out.counts[d](x - unit.x0, y - unit.y0).add(counted); });
          ++pixel.primaries;
          pixel.hits += hit ? 1 : 0;
        }
      }
    }
    out.spectra = primaries_.detection().take_spectra();
  }

  std::size_t detectors_;
  PrimariesPerPixel primaries_per_pixel_;
  DirectPrimaries primaries_;
};

}  // namespace

std::unique_ptr<UnitWorker> make_direct_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options) {
  return std::make_unique<DirectWorker>(scene, options);
}

}  // namespace surf::mc
