// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "surf/core/progress.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/request/simulation_options.h"
#include "surf/mc/results/unit_tally.h"
#include "surf/mc/transport/observer.h"

namespace surf::mc {

class PlanarControls;

/// Simulates units of work, one thread's share. A unit's tally depends on scene, options and unit
/// alone.
class UnitWorker {
 public:
  virtual ~UnitWorker() = default;

  /// `out` is empty at first. `observer` may be null. Throws Interrupted, with `out` of no use.
  virtual void simulate(const WorkUnit& unit, Observer* observer, UnitTally& out) = 0;

  const CancelToken* cancel = nullptr;  ///< may be null
};

// How many primaries a pixel gets (fixed_sampler.h, adaptive_sampler.h) goes by the options'
// budget; where their outcome comes from (direct_source.h, replay_source.h) by which of these is
// called. Scene, options and libraries must outlive the worker.
std::unique_ptr<UnitWorker> make_direct_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options);
/// `controls` are needed with an accuracy, and not used without.
std::unique_ptr<UnitWorker> make_replay_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options,
                                               const Libraries& libraries,
                                               PlanarControls* controls = nullptr);

}  // namespace surf::mc
