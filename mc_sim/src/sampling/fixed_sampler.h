// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "sampling/primaries_per_pixel.h"
#include "sampling/primary_source.h"
#include "sampling/unit_worker.h"

namespace surf::mc {

/// Gives each pixel a number of primaries that is settled beforehand.
template <PrimarySource Source>
class FixedSampler final : public UnitWorker {
 public:
  template <class... Arguments>
  FixedSampler(const Scene::Impl& scene, const SimulationOptions& options,
               const Arguments&... arguments)
      : detectors_(options.detectors.size()), odd_counts_(options.odd_counts),
        primaries_per_pixel_(scene.scan, options), source_(scene, options, arguments...) {}

  void simulate(const WorkUnit& unit, Observer* observer, UnitTally& out) override {
    clear(out, unit, detectors_);
    if (odd_counts_) out.odd_counts = out.counts;
    ranges_.clear();
    expected_.clear();
    for (int y = unit.y0; y < unit.y1; ++y)
      for (int x = unit.x0; x < unit.x1; ++x) {
        const std::int64_t end =
            std::min(primaries_per_pixel_.of(x, y), unit.first_electron + unit.electrons);
        expected_.push_back(std::max<std::int64_t>(end - unit.first_electron, 0));
        const auto first =
            static_cast<std::uint64_t>(primaries_per_pixel_.first(x, y) + unit.first_electron);
        ranges_.push_back({first, first + static_cast<std::uint64_t>(expected_.back())});
      }
    source_.begin({unit, expected_, observer, cancel});
    source_.serve(ranges_, [&](std::size_t i, std::uint64_t number, bool hit, const auto& counts) {
      PixelTally& pixel = out.pixels.data()[i];
      pixel.model = Source::model;
      ++pixel.primaries;
      pixel.hits += hit ? 1 : 0;
      for (std::size_t d = 0; d < detectors_; ++d) {
        const int electrons = counts(d).first;
        out.counts[d].data()[i].add(electrons);
        if (odd_counts_ && number % 2 == 1) out.odd_counts[d].data()[i].add(electrons);
      }
    });
    source_.finish(out);
  }

 private:
  std::size_t detectors_;
  bool odd_counts_;
  PrimariesPerPixel primaries_per_pixel_;
  Source source_;
  std::vector<PrimaryRange> ranges_;
  std::vector<std::int64_t> expected_;
};

}  // namespace surf::mc
