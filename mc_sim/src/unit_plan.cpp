// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/unit_plan.h"

#include <algorithm>

#include "surf/core/error.h"
#include "unit_worker.h"

namespace surf::mc {
namespace {

// A journal may have been kept for something else.
void check_shape(const SimulationResult& result, const WorkUnit& u, const UnitTally& tally) {
  bool fits = tally.counts.size() == result.counts.size() &&
              tally.controls.size() == result.controls.size() &&
              tally.pixels.width() == u.x1 - u.x0 && tally.pixels.height() == u.y1 - u.y0 &&
              (result.spectra.empty() || tally.spectra.size() == result.spectra.size());
  for (const auto& grid : tally.counts) fits = fits && grid.size() == tally.pixels.size();
  if (!fits)
    throw InvalidInput("journal of units", "a unit's tally is of another simulation",
                       "Begin anew, without the journal");
}

}  // namespace

UnitPlan::UnitPlan(const Scan& scan, const SimulationOptions& options) : scan_(scan) {
  if (accuracy_of(options.budget) > 0) {   // a pixel looks at its neighbours within the tile: fixed tiles
    run_ = height_ = tile;
    by_pixel_ = true;
    runs_ = (scan.width + tile - 1) / tile;
    total_ = static_cast<double>(scan.width) * scan.height;
    return;
  }
  const Share share(scan, options);
  if (const double dose = dose_of(options.budget); dose > 0) {
    for (int y = 0; y < scan.height; ++y)
      for (int x = 0; x < scan.width; ++x) {
        const std::int64_t n = share.of(x, y);
        most_ = std::max(most_, n);
        total_ += static_cast<double>(n);
      }
  } else {
    most_ = electrons_of(options.budget);
    total_ = static_cast<double>(most_) * scan.width * scan.height;
  }
  // Long jobs have many units, which somebody has to merge: longer ones, while there are enough for all.
  std::int64_t pixels = std::max<std::int64_t>(1, (total_ > much ? 4 : 1) * chunk_ / most_);
  std::int64_t longest = scan.width;
  if (options.method == Method::replay) {   // pixels of a tile share what they read of the library
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
  return {x, y, std::min(x + run_, scan_.width), std::min(y + height_, scan_.height), first,
          std::min(chunk_, most_ - first)};
}

double UnitPlan::done(const WorkUnit& unit, const UnitTally& tally) const {
  return by_pixel_ ? static_cast<double>(unit.x1 - unit.x0) * (unit.y1 - unit.y0)
                   : static_cast<double>(tally.balance.incident);
}

UnitTally empty_tally(const WorkUnit& unit, const SimulationOptions& options) {
  UnitTally tally;
  clear(tally, unit, options.detectors.size());
  if (accuracy_of(options.budget) > 0)
    tally.controls.assign(options.detectors.size(), Grid<Control>(tally.pixels.width(), tally.pixels.height()));
  return tally;
}

SimulationResult empty_result(const Scan& scan, const SimulationOptions& options) {
  SimulationResult result;
  result.detectors = options.detectors;
  const std::string folder = tally_bytes(scan, options) > options.tally_memory ? options.scratch_folder : "";
  result.pixels = LargeGrid<PixelTally>(scan.width, scan.height, folder);
  for (std::size_t d = 0; d < options.detectors.size(); ++d)
    result.counts.emplace_back(scan.width, scan.height, folder);
  for (std::size_t d = 0; accuracy_of(options.budget) > 0 && d < options.detectors.size(); ++d)
    result.controls.emplace_back(scan.width, scan.height, folder);
  result.budget = options.budget;
  result.seed = options.seed;
  return result;
}

void merge(SimulationResult& result, const WorkUnit& u, const UnitTally& tally) {
  check_shape(result, u, tally);
  for (int y = u.y0; y < u.y1; ++y)
    for (int x = u.x0; x < u.x1; ++x) {
      result.pixels(x, y) += tally.pixels(x - u.x0, y - u.y0);
      for (std::size_t d = 0; d < result.counts.size(); ++d)
        result.counts[d](x, y) += tally.counts[d](x - u.x0, y - u.y0);
      for (std::size_t d = 0; d < result.controls.size(); ++d)
        result.controls[d](x, y) = tally.controls[d](x - u.x0, y - u.y0);
    }
  if (result.spectra.empty()) result.spectra = tally.spectra;
  else
    for (std::size_t d = 0; d < tally.spectra.size(); ++d) result.spectra[d] += tally.spectra[d];
  result.balance += tally.balance;
}

}  // namespace surf::mc
