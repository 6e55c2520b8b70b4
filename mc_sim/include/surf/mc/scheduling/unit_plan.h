// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include "surf/mc/request/simulation_options.h"
#include "surf/mc/results/unit_tally.h"

namespace surf::mc {

/// How `simulate` cuts a scan into units of work: runs of pixels along a row, or tiles where they
/// are replayed. Long counts of electrons are split, so that one pixel can keep all threads busy.
/// For whoever keeps, sends or shows units by their number (`UnitJournal`): it depends on the scan
/// and the options alone.
class UnitPlan {
 public:
  UnitPlan(const Scan& scan, const SimulationOptions& options);

  std::size_t units() const;
  WorkUnit unit(std::size_t number) const;  ///< numbered rather than listed: there may be very many

  /// Primaries of the pixel that has most.
  std::int64_t most() const { return most_; }
  /// Primaries; with a wanted accuracy, pixels.
  double total() const { return total_; }
  double done(const WorkUnit& unit, const UnitTally& tally) const;

 private:
  static constexpr std::int64_t direct_chunk = 4096;  // primaries: a fraction of a second
  static constexpr std::int64_t replayed_chunk = 16 * direct_chunk;
  static constexpr double much = 1e9;  // primaries
  static constexpr int tile = 32;
  Scan scan_;
  bool by_pixel_ = false;
  std::int64_t chunk_ = direct_chunk;
  int height_ = 1;
  std::int64_t most_ = 1;
  double total_ = 0;
  int run_ = 1;
  std::int64_t runs_ = 1, chunks_ = 1;
};

}  // namespace surf::mc
