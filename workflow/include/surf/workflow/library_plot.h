// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/io/plot.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/workflow/measured_yields.h"

namespace surf::workflow {

struct LibraryPlotOptions {
  std::vector<mc::Material> materials;  ///< 1 to 8
  std::vector<double> energies_ev;      ///< beam energies, at least one, 100 to 30000
  /// Beam angles at which yields are shown, 0 to below 90. Empty: 0; with a single energy 0 to 75
  /// in steps of 15.
  std::vector<double> tilts_deg;
  mc::Physics physics;
  std::uint64_t seed = 1;
  /// Cascades per library, at least 1. A simulation takes 10240 or more (mc::library_size).
  std::size_t cascades = 10240;
  int threads = 0;                      ///< 0: one per hardware thread
  std::vector<MeasuredYield> measured;  ///< shown beside the yields at normal incidence
  Watch watch;
};

/// The parameter library.tilt.
void describe(ParameterVisitor& visit, LibraryPlotOptions& options);

/// Plots the content of libraries and the yields that follow from it: how deep and how far
/// primaries get, against the energy if there are several; and the yields of flat specimens,
/// replayed from the same libraries, with their standard errors, against the energy or else the
/// tilt. Throws UsageError for options out of range, Interrupted.
io::Plot plot_libraries(const LibraryPlotOptions& options, mc::LibrarySource& libraries);

}  // namespace surf::workflow
