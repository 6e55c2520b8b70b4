// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "surf/core/progress.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/results/simulation_result.h"
#include "surf/mc/sampling/simulate_unit.h"
#include "surf/mc/scheduling/unit_journal.h"
#include "surf/mc/transport/observer.h"

namespace surf::mc {

/// The observer of each of the simulating threads, asked for once per thread, 0 to the number of
/// threads less one. They must outlive the simulation.
using ObserverOfThread = std::function<Observer*(int thread)>;

class UnitScheduler;

/// Who takes part in a simulation, and who watches it. All of it may be left out.
struct SimulationContext {
  Watch watch;                 ///< counts primaries, with an accuracy pixels; told after each unit
  ObserverOfThread observers;  ///< every track is then followed to its end, as in `simulate_unit`
  /// Is told of every finished unit and asked for those done before: of the same scene and options,
  /// `tile_pixels` among them.
  UnitJournal* journal = nullptr;
  LibrarySource* libraries =
      nullptr;  ///< where replay gets its cascades; null: they are made on the spot
  UnitScheduler* scheduler = nullptr;  ///< who simulates which units; null: threads of this process

  /// Throws UsageError for what cannot go together.
  void check(const SimulationOptions& options, const Scene& scene) const;
};

/// Simulates the whole scan, in parallel. On cancellation returns what is done. Replay cannot serve
/// observers, nor physics without continuous loss; observers go with neither a journal nor a
/// scheduler nor an accuracy (UsageError). Where the scheduler does not collect, the result counts
/// nothing and is complete, and the journal is not used.
SimulationResult simulate(const Scene& scene, const SimulationOptions& options,
                          const SimulationContext& context = {});

}  // namespace surf::mc
