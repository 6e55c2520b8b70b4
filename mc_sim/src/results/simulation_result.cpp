// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/results/simulation_result.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf::mc {
namespace {

// A journal may have been kept for something else.
void check_shape(const SimulationResult& result, const WorkUnit& u, const UnitTally& tally) {
  bool fits = tally.counts.size() == result.counts.size() &&
              tally.controls.size() == result.controls.size() &&
              tally.odd_counts.size() == result.odd_counts.size() &&
              tally.pixels.width() == u.x1 - u.x0 && tally.pixels.height() == u.y1 - u.y0 &&
              (result.spectra.empty() || tally.spectra.size() == result.spectra.size());
  for (const auto* grids : {&tally.counts, &tally.odd_counts})
    for (const auto& grid : *grids) fits = fits && grid.size() == tally.pixels.size();
  if (!fits)
    throw InvalidInput("journal of units", "a unit's tally is of another simulation",
                       "Begin anew, without the journal");
}

}  // namespace

void clear(UnitTally& tally, const WorkUnit& unit, std::size_t detectors) {
  const int width = unit.x1 - unit.x0, height = unit.y1 - unit.y0;
  tally.pixels = Grid<PixelTally>(width, height);
  tally.counts.assign(detectors, Grid<Counts>(width, height));
}

Estimate SimulationResult::yield(std::size_t detector, int x, int y) const {
  const std::int64_t n = pixels(x, y).primaries;
  Estimate e = estimate(n, counts[detector](x, y));
  if (!controls.empty()) {
    // The control's mean is over all cascades, the pixel's among them: with the covariance at its
    // largest the two errors add up to no more than this.
    const Control& c = controls[detector](x, y);
    const double common =
        library_cascades > 0
            ? std::sqrt(static_cast<double>(n) / static_cast<double>(library_cascades))
            : 0;
    e.mean += c.mean;
    e.standard_error =
        std::sqrt(e.standard_error * e.standard_error + c.standard_error * c.standard_error +
                  2 * common * e.standard_error * c.standard_error);
  }
  e.mean *= detectors[detector].efficiency;
  e.standard_error *= detectors[detector].efficiency;
  return e;
}

void SimulationResult::release() const {
  pixels.release();
  for (const auto& grid : counts) grid.release();
  for (const auto& grid : odd_counts) grid.release();
  for (const auto& grid : controls) grid.release();
}

std::size_t tally_bytes(const Scan& scan, const SimulationOptions& options) {
  return static_cast<std::size_t>(scan.width) * static_cast<std::size_t>(scan.height) *
         (sizeof(PixelTally) +
          options.detectors.size() * (sizeof(Counts) + (options.odd_counts ? sizeof(Counts) : 0) +
                                      (accuracy_of(options.budget) > 0 ? sizeof(Control) : 0)));
}

UnitTally empty_tally(const WorkUnit& unit, const SimulationOptions& options) {
  UnitTally tally;
  clear(tally, unit, options.detectors.size());
  if (options.odd_counts) tally.odd_counts = tally.counts;
  if (accuracy_of(options.budget) > 0)
    tally.controls.assign(options.detectors.size(),
                          Grid<Control>(tally.pixels.width(), tally.pixels.height()));
  return tally;
}

SimulationResult empty_result(const Scan& scan, const SimulationOptions& options) {
  SimulationResult result;
  result.detectors = options.detectors;
  const std::string folder =
      tally_bytes(scan, options) > options.tally_memory ? options.scratch_folder : "";
  result.pixels = LargeGrid<PixelTally>(scan.width, scan.height, folder);
  for (std::size_t d = 0; d < options.detectors.size(); ++d)
    result.counts.emplace_back(scan.width, scan.height, folder);
  for (std::size_t d = 0; options.odd_counts && d < options.detectors.size(); ++d)
    result.odd_counts.emplace_back(scan.width, scan.height, folder);
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
      for (std::size_t d = 0; d < result.odd_counts.size(); ++d)
        result.odd_counts[d](x, y) += tally.odd_counts[d](x - u.x0, y - u.y0);
      for (std::size_t d = 0; d < result.controls.size(); ++d)
        result.controls[d](x, y) = tally.controls[d](x - u.x0, y - u.y0);
    }
  if (result.spectra.empty()) result.spectra = tally.spectra;
  else
    for (std::size_t d = 0; d < tally.spectra.size(); ++d) result.spectra[d] += tally.spectra[d];
  result.balance += tally.balance;
}

void add_round(SimulationResult& result, const SimulationResult& round) {
  const int width = result.pixels.width(), height = result.pixels.height();
  if (round.pixels.width() != width || round.pixels.height() != height ||
      round.counts.size() != result.counts.size() ||
      round.odd_counts.size() != result.odd_counts.size() || !round.controls.empty() ||
      !result.controls.empty())
    throw InvalidInput("round of a simulation", "it is of another image",
                       "Add rounds of one scan and its detectors, without an accuracy");
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      result.pixels(x, y) += round.pixels(x, y);
      for (std::size_t d = 0; d < result.counts.size(); ++d)
        result.counts[d](x, y) += round.counts[d](x, y);
      for (std::size_t d = 0; d < result.odd_counts.size(); ++d)
        result.odd_counts[d](x, y) += round.odd_counts[d](x, y);
    }
  for (std::size_t d = 0; d < result.spectra.size() && d < round.spectra.size(); ++d)
    result.spectra[d] += round.spectra[d];
  result.balance += round.balance;
  result.library_cascades = std::max(result.library_cascades, round.library_cascades);
  result.library_seconds += round.library_seconds;
  result.seconds += round.seconds;
  result.recalled += round.recalled;
  result.complete = result.complete && round.complete;
}

}  // namespace surf::mc
