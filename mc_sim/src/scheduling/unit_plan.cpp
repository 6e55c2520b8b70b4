// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/scheduling/unit_plan.h"

#include <algorithm>

#include "sampling/primaries_per_pixel.h"

namespace surf::mc {

UnitPlan::UnitPlan(const Scan& scan, const SimulationOptions& options) : scan_(scan) {
  if (accuracy_of(options.budget) >
      0) {  // a pixel looks at its neighbours within the tile: fixed tiles
    run_ = height_ = tile;
    by_pixel_ = true;
    runs_ = (scan.width + tile - 1) / tile;
    total_ = static_cast<double>(scan.width) * scan.height;
    return;
  }
  const PrimariesPerPixel primaries(scan, options);
  if (options.primaries || dose_of(options.budget) > 0) {
    for (int y = 0; y < scan.height; ++y)
      for (int x = 0; x < scan.width; ++x) {
        const std::int64_t n = primaries.of(x, y);
        most_ = std::max(most_, n);
        total_ += static_cast<double>(n);
      }
  } else {
    most_ = electrons_of(options.budget);
    total_ = static_cast<double>(most_) * scan.width * scan.height;
  }
  // Long jobs have many units, which somebody has to merge: longer ones, while there are enough for
  // all.
  std::int64_t pixels = std::max<std::int64_t>(1, (total_ > much ? 4 : 1) * chunk_ / most_);
  std::int64_t longest = scan.width;
  if (options.method == Method::replay) {  // pixels of a tile share what they read of the library
    chunk_ = replayed_chunk;
    pixels = std::clamp<std::int64_t>(4 * chunk_ / most_, 1, tile * tile);
    longest = std::min(longest, std::int64_t{tile});
  }
  pixels = std::min<std::int64_t>(pixels, options.tile_pixels);
  run_ = static_cast<int>(std::min(pixels, longest));
  runs_ = (scan.width + run_ - 1) / run_;
  if (options.method == Method::replay) height_ = static_cast<int>(pixels / run_);
  chunks_ = (most_ + chunk_ - 1) / chunk_;
}

std::size_t UnitPlan::units() const {
  return static_cast<std::size_t>(chunks_) * static_cast<std::size_t>(runs_) *
         static_cast<std::size_t>((scan_.height + height_ - 1) / height_);
}

WorkUnit UnitPlan::unit(std::size_t number) const {
  const auto n = static_cast<std::int64_t>(number);
  const std::int64_t first = n % chunks_ * chunk_;
  const int x = static_cast<int>(n / chunks_ % runs_) * run_;
  const int y = static_cast<int>(n / chunks_ / runs_) * height_;
  return {x,
          y,
          std::min(x + run_, scan_.width),
          std::min(y + height_, scan_.height),
          first,
          std::min(chunk_, most_ - first)};
}

double UnitPlan::done(const WorkUnit& unit, const UnitTally& tally) const {
  return by_pixel_ ? static_cast<double>(unit.x1 - unit.x0) * (unit.y1 - unit.y0)
                   : static_cast<double>(tally.balance.incident);
}

}  // namespace surf::mc
