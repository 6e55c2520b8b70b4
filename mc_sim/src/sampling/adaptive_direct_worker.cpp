// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "sampling/adaptive_sampling.h"
#include "sampling/direct_primaries.h"
#include "sampling/primaries_per_pixel.h"
#include "sampling/unit_worker.h"

namespace surf::mc {

namespace {

// Serves each pixel until a wanted accuracy is reached, with electrons that are followed. As in
// spending_worker.cpp a pilot, pooled with its neighbours', sets the number and is not counted.
class DirectSpendingWorker : public UnitWorker {
 public:
  DirectSpendingWorker(const Scene::Impl& scene, const SimulationOptions& options)
      : options_(options), primaries_per_pixel_(scene.scan, options), primaries_(scene, options),
        detectors_(options.detectors.size()) {}

  void simulate(const WorkUnit& unit, Observer*, UnitTally& out) override {
    clear(out, unit, detectors_);
    out.controls.assign(detectors_, Grid<Control>(unit.x1 - unit.x0, unit.y1 - unit.y0));
    NoObserver nobody;
    auto transport = primaries_.transport(nobody, true, out.balance);
    pixels_.assign(out.pixels.size(), {});
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      Pixel& p = pixels_[i];
      p.x = unit.x0 + static_cast<int>(i) % out.pixels.width();
      p.y = unit.y0 + static_cast<int>(i) / out.pixels.width();
      p.counted.resize(detectors_);
      follow(transport, p, pilot_primaries, nullptr, [](std::size_t, int) {});
    }
    std::vector<double> wanted(pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      wanted[i] = reserve_of_primaries * foretold(i, out.pixels.width(), out.pixels.height());
    for (std::size_t i = 0; i < pixels_.size(); ++i) serve(transport, i, wanted[i], out);
  }

 private:
  struct Pixel {
    int x = 0, y = 0;
    std::int64_t used = 0;
    bool hit = false;                 // any of its primaries
    std::vector<Sample> counted;      // the pilot's, then those that count; per detector
  };

  template <class Loop, class Keep>
  void follow(Loop& transport, Pixel& p, std::int64_t primaries, PixelTally* tally, const Keep& keep) {
    for (const std::int64_t end = p.used + primaries; p.used < end; ++p.used) {
      check();
      const bool hit = primaries_.run(transport, p.x, p.y, primaries_per_pixel_.number(p.x, p.y),
                                      static_cast<std::uint64_t>(p.used), [&](std::size_t d, int counted) {
                                        p.counted[d].add(counted);
                                        keep(d, counted);
                                      });
      p.hit |= hit;
      if (!tally) continue;
      ++tally->primaries;
      tally->hits += hit ? 1 : 0;
    }
  }

  double needed(double variance, double mean) const {
    const double t = wanted_error(options_, mean);
    return t > 0 ? variance / (t * t) : HUGE_VAL;
  }

  double foretold(std::size_t i, int width, int height) const {
    double most = fewest_primaries;
    for (std::size_t d = 0; d < detectors_; ++d) {
      Sample all;
      for_pilots_near(i, width, height, [&](std::size_t k) { all += pixels_[k].counted[d]; });
      const double variance = std::max(all.variance(), pixels_[i].counted[d].variance());
      most = std::max(most, needed(variance + all.unseen_variance(), all.mean()));
    }
    return most;
  }

  template <class Loop>
  void serve(Loop& transport, std::size_t i, double wanted, UnitTally& out) {
    Pixel& p = pixels_[i];
    if (!p.hit) wanted = fewest_primaries;   // as far as can be told, the beam misses everything
    p.counted.assign(detectors_, {});
    PixelTally& tally = out.pixels.data()[i];
    const auto keep = [&](std::size_t d, int counted) { out.counts[d].data()[i].add(counted); };
    for (int round = 0; round <= most_rounds; ++round) {
      const std::int64_t missing = primaries(wanted) - tally.primaries;
      if (missing <= 0) break;
      follow(transport, p, missing, &tally, keep);
      double more = 0;
      for (const Sample& s : p.counted) more = std::max(more, needed(s.high_variance(), s.mean()));
      const auto count = static_cast<double>(tally.primaries);
      wanted = more > count ? std::max(1.02 * more, least_growth * count) : 0;
    }
    tally.model = tally.hits > 0 ? PixelModel::direct : PixelModel::none;
  }

  // No more than a pixel takes that one primary in a hundred gives an electron: without a floor a dark
  // one would go on for ever.
  std::int64_t primaries(double wanted) const {
    const double most = std::min(std::max(1e4, 100 / (accuracy_of(options_.budget) * accuracy_of(options_.budget))), 2147483648.0);
    return static_cast<std::int64_t>(std::min(std::ceil(wanted), most));
  }

  const SimulationOptions& options_;
  PrimariesPerPixel primaries_per_pixel_;
  DirectPrimaries primaries_;
  std::size_t detectors_;
  std::vector<Pixel> pixels_;
};

}  // namespace

std::unique_ptr<UnitWorker> make_direct_spending_worker(const Scene::Impl& scene,
                                                        const SimulationOptions& options) {
  return std::make_unique<DirectSpendingWorker>(scene, options);
}

}  // namespace surf::mc
