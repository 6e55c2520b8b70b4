// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "surf/core/error.h"
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

  /// Looked at with each primary: a unit takes seconds where electrons are fast. May be null.
  const CancelToken* cancel = nullptr;

 protected:
  void check() const {
    if (cancel && cancel->cancelled()) throw Interrupted();
  }
};

std::unique_ptr<UnitWorker> make_direct_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options);
std::unique_ptr<UnitWorker> make_replay_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options,
                                               const Libraries& libraries);
/// For `accuracy`, these two: pixels of a unit are served as they need.
std::unique_ptr<UnitWorker> make_direct_spending_worker(const Scene::Impl& scene,
                                                        const SimulationOptions& options);
std::unique_ptr<UnitWorker> make_spending_worker(const Scene::Impl& scene,
                                                 const SimulationOptions& options,
                                                 const Libraries& libraries,
                                                 PlanarControls& controls);

}  // namespace surf::mc
