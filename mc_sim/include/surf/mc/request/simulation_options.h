// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/parameters.h"
#include "surf/mc/request/budget.h"
#include "surf/mc/transport/detector.h"

namespace surf::mc {

/// How electrons are simulated. Replay retraces stored cascades; both have the same statistics.
enum class Method { direct, replay };

/// How the work is carried out. Nothing of it changes the result.
struct Execution {
  int threads = 0;         ///< 0: one per hardware thread
  int tile_pixels = 1024;  ///< pixels in a unit of work, >= 1
  /// Tallies of more bytes than this (16 per pixel, and 16 per pixel and detector) go into scratch
  /// files in `scratch_folder`; never where that is empty.
  std::size_t tally_memory = std::size_t{1} << 30;
  std::string scratch_folder;
};

void describe(ParameterVisitor& visit, Execution& execution);

/// Primaries of each pixel, by number: from `first` to before `end`.
struct PrimaryNumbers {
  Grid<std::int64_t> first, end;  ///< of the scan's size, 0 <= first <= end <= 2^31
};

struct SimulationOptions : Execution {
  Budget budget;  ///< no TimeLimit
  /// The primaries to simulate, in place of a budget of electrons per pixel: what is added to an
  /// image in a further round. Null: those of the budget.
  std::shared_ptr<const PrimaryNumbers> primaries;
  /// Also count primaries of odd number apart, for estimates from neighbours; not with an accuracy.
  /// Pixels then share single cascades of a library and no runs of them.
  bool odd_counts = false;
  Method method = Method::direct;
  bool planar_control = true;  ///< with an accuracy: average the difference to a plane's outcome
  std::uint64_t seed = 1;
  std::vector<Detector> detectors = default_detectors();  ///< at least one; unique names
  bool spectra = false;                                   ///< collect `Spectra` per detector
  /// With an accuracy, all libraries together grow beyond their least size only up to this many
  /// bytes.
  double library_memory = 2.0 * (1u << 30);
  std::size_t least_cascades = 0;  ///< of each library, for neighbours that share its error
};

}  // namespace surf::mc
