// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay_site.h"
#include "subset.h"
#include "surf/core/random.h"
#include "unit_worker.h"

namespace surf::mc {

namespace {

constexpr std::int64_t worth_looking_around = 50;   // primaries of a pixel

// A settled number of primaries per pixel, each a cascade of the pixel's own part of the library.
class ReplayWorker : public UnitWorker {
 public:
  ReplayWorker(const Scene::Impl& scene, const SimulationOptions& options,
               const Libraries& libraries)
      : options_(options), share_(scene.scan, options), replay_(scene, options, libraries) {
    for (const auto& l : libraries)
      if (l) cascades_ = cascades_ == 0 ? l->cascades() : std::min(cascades_, l->cascades());
  }

  void simulate(const WorkUnit& unit, Observer*, UnitTally& out) override {
    clear(out, unit, options_.detectors.size());
    replay_.balance() = {};
    for (int y = unit.y0; y < unit.y1; ++y)
      for (int x = unit.x0; x < unit.x1; ++x) pixel(unit, x, y, out);
    out.balance += replay_.balance();
    out.spectra = replay_.detection().take_spectra();
  }

 private:
  void pixel(const WorkUnit& unit, int x, int y, UnitTally& out) {
    const std::uint64_t number = share_.number(x, y);
    const std::int64_t end = std::min(share_.of(x, y), unit.first_electron + unit.electrons);
    const ReplaySite site =
        replay_.site(x, y, end - unit.first_electron >= worth_looking_around);
    replay_.go_to(site);
    // The pixel's own stream has electrons as its last coordinate; this is beyond all of them.
    RandomStream own(options_.seed, number, subset_stream);
    const std::uint32_t a = own.bits(), b = own.bits();
    const Subset subset(cascades_, a, b);
    PixelTally& pixel = out.pixels(x - unit.x0, y - unit.y0);
    pixel.model = PixelModel::replay;
    for (std::int64_t e = unit.first_electron; e < end; ++e) {
      const auto electron = static_cast<std::uint64_t>(e);
      Gun::Start start = site.middle;
      if (!site.single) {
        RandomStream random(options_.seed, number, electron);
        start = replay_.gun().primary(x, y, random);
      }
      ReplayedPrimary primary{options_.seed, number, electron, subset[electron], 0};
      primary.azimuth = azimuth_of(primary);
      replay_.fetch(site, subset[electron + 1]);
      pixel.hits += replay_.run(site, start, primary) ? 1 : 0;
      ++pixel.primaries;
      for (std::size_t d = 0; d < out.counts.size(); ++d)
        out.counts[d](x - unit.x0, y - unit.y0).add(replay_.detection().counts()[d]);
      replay_.detection().end_primary();
    }
  }

  static constexpr std::uint64_t subset_stream = std::uint64_t{1} << 42;

  const SimulationOptions& options_;
  Share share_;
  SiteReplay replay_;
  std::size_t cascades_ = 0;
};

}  // namespace

std::unique_ptr<UnitWorker> make_replay_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options,
                                               const Libraries& libraries) {
  return std::make_unique<ReplayWorker>(scene, options, libraries);
}

}  // namespace surf::mc
