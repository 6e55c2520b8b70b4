// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/image_rows.h"
#include "surf/core/large_grid.h"
#include "surf/mc/cascades/library_size.h"
#include "surf/mc/geometry/beam.h"
#include "surf/mc/request/simulation_options.h"
#include "surf/mc/results/unit_tally.h"

namespace surf::mc {

struct SimulationResult {
  std::vector<Detector> detectors;  ///< as in the options
  LargeGrid<PixelTally> pixels;
  std::vector<LargeGrid<Counts>> counts;      ///< per detector
  std::vector<LargeGrid<Counts>> odd_counts;  ///< per detector, of odd primaries, where asked for
  std::vector<LargeGrid<Control>> controls;   ///< per detector, with `accuracy`
  std::vector<Spectra> spectra;               ///< per detector, where asked for
  Balance balance;
  Budget budget;  ///< as in the options
  std::uint64_t seed = 1;
  std::size_t library_cascades = 0;          ///< of each material, with replay
  std::vector<CascadeYield> cascade_yields;  ///< with `accuracy`: per material and detector
  double library_seconds = 0;                ///< wall time to get the libraries
  std::int64_t recalled = 0;  ///< primaries among `balance` that a journal knew already
  bool complete = true;       ///< false when cancelled: some pixels have fewer primaries, or none
  double seconds = 0;         ///< wall time of the simulation, scene building and recalled units
                              ///< apart

  /// Yield of a detector at a pixel, its efficiency included. With a control the standard error
  /// includes the library's own share.
  Estimate yield(std::size_t detector, int x, int y) const;

  /// For loops over many pixels: see `LargeGrid::release`.
  void release() const;
};

/// Per detector the channels NAME and NAME.stderr, in counts per primary; with a dose also
/// NAME.shot, what a microscope would show: electrons counted over the mean number of primaries.
/// Then valid: 1 where the beam meets the specimen and at least one primary was simulated. Placed
/// in the scan plane.
Image make_image(const SimulationResult& result, const Scan& scan);

/// The same, row by row. Refers to `result`.
ImageRows make_image_rows(const SimulationResult& result, const Scan& scan);

/// Bytes of a result's tallies.
std::size_t tally_bytes(const Scan& scan, const SimulationOptions& options);

/// A unit's tally that counts nothing: for units that somebody else simulates.
UnitTally empty_tally(const WorkUnit& unit, const SimulationOptions& options);

/// A result that counts nothing yet. `scratch_folder` as in the options, for tallies too large for
/// the memory.
SimulationResult empty_result(const Scan& scan, const SimulationOptions& options);

/// Adds a unit's tally; the order of units does not matter. Throws InvalidInput for one of another
/// simulation.
void merge(SimulationResult& result, const WorkUnit& unit, const UnitTally& tally);

/// Adds a further round of the same image, of other primaries. Throws InvalidInput for one of
/// another size, or with controls.
void add_round(SimulationResult& result, const SimulationResult& round);

}  // namespace surf::mc
