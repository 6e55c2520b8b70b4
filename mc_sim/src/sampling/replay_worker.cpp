// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/replay_site.h"
#include "sampling/cache_blocks.h"
#include "sampling/primaries_per_pixel.h"
#include "sampling/stratified_permutation.h"
#include "sampling/unit_worker.h"
#include "surf/core/random.h"
#include "transport/random_streams.h"

namespace surf::mc {

namespace {

constexpr std::int64_t worth_looking_around = 50;   // primaries of a pixel

// A settled number of primaries per pixel, each a cascade of the pixel's own part of the library.
class ReplayWorker : public UnitWorker {
 public:
  ReplayWorker(const Scene::Impl& scene, const SimulationOptions& options,
               const Libraries& libraries)
      : options_(options), primaries_per_pixel_(scene.scan, options), replay_(scene, options, libraries) {
    for (const auto& l : libraries)
      if (l) cascades_ = cascades_ == 0 ? l->cascades() : std::min(cascades_, l->cascades());
  }

  void simulate(const WorkUnit& unit, Observer*, UnitTally& out) override {
    clear(out, unit, options_.detectors.size());
    replay_.balance() = {};
    look(unit);
    by_blocks(pixels_, cascades_, replay_,
              [&](std::size_t i, std::uint64_t electron, std::size_t cascade) {
                serve(i, electron, cascade, out);
              });
    out.balance += replay_.balance();
    out.spectra = replay_.detection().take_spectra();
  }

 private:
  struct Pixel {
    int x, y;
    std::uint64_t number;
    std::uint64_t used, end;  // of its primaries: the first, and one past the last
    ReplaySite site;
    StratifiedPermutation subset;
  };

  void look(const WorkUnit& unit) {
    pixels_.clear();
    for (int y = unit.y0; y < unit.y1; ++y)
      for (int x = unit.x0; x < unit.x1; ++x) {
        const std::uint64_t number = primaries_per_pixel_.number(x, y);
        const std::int64_t end = std::min(primaries_per_pixel_.of(x, y), unit.first_electron + unit.electrons);
        RandomStream own(options_.seed, number, random_streams::order_of_cascades);
        const std::uint32_t a = own.bits(), b = own.bits();
        pixels_.push_back({x, y, number, static_cast<std::uint64_t>(unit.first_electron),
                           static_cast<std::uint64_t>(std::max<std::int64_t>(end, 0)),
                           replay_.site(x, y, end - unit.first_electron >= worth_looking_around),
                           StratifiedPermutation(cascades_, a, b)});
      }
  }

  void serve(std::size_t i, std::uint64_t electron, std::size_t cascade, UnitTally& out) {
    check();
    const Pixel& p = pixels_[i];
    Gun::Start start = p.site.middle;
    if (!p.site.single) {
      RandomStream random(options_.seed, p.number, electron);
      start = replay_.gun().primary(p.x, p.y, random);
    }
    ReplayedPrimary primary{options_.seed, p.number, electron, cascade, 0};
    primary.azimuth = azimuth_of(primary);
    PixelTally& tally = out.pixels.data()[i];
    tally.model = PixelModel::replay;
    tally.hits += replay_.run(p.site, start, primary) ? 1 : 0;
    ++tally.primaries;
    for (std::size_t d = 0; d < out.counts.size(); ++d)
      out.counts[d].data()[i].add(replay_.detection().counts()[d]);
    replay_.detection().end_primary();
  }

  const SimulationOptions& options_;
  PrimariesPerPixel primaries_per_pixel_;
  SiteReplay replay_;
  std::size_t cascades_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace

std::unique_ptr<UnitWorker> make_replay_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options,
                                               const Libraries& libraries) {
  return std::make_unique<ReplayWorker>(scene, options, libraries);
}

}  // namespace surf::mc
