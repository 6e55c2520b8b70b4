// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "dose.h"
#include "surf/core/error.h"
#include "surf/core/progress.h"
#include "surf/mc/cascade_library.h"
#include "surf/mc/observer.h"
#include "surf/mc/scene.h"
#include "surf/mc/simulate.h"

namespace surf::mc {

class PlaneControls;

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

/// Libraries by material; null where electrons are followed directly.
using Libraries = std::vector<std::shared_ptr<const CascadeLibrary>>;

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
                                                 PlaneControls& controls);

/// A unit's tallies, all zero.
inline void clear(UnitTally& tally, const WorkUnit& unit, std::size_t detectors) {
  const int width = unit.x1 - unit.x0, height = unit.y1 - unit.y0;
  tally.pixels = Grid<PixelTally>(width, height);
  tally.counts.assign(detectors, Grid<Counts>(width, height));
}

/// How many primaries each pixel gets, where that is settled beforehand.
class Share {
 public:
  Share(const Scan& scan, const SimulationOptions& o)
      : width_(scan.width), electrons_(electrons_of(o.budget)), dose_(dose_of(o.budget)), seed_(o.seed) {}

  std::int64_t of(int x, int y) const {
    return dose_ > 0 ? primaries_of_pixel(dose_, seed_, number(x, y)) : electrons_;
  }
  std::uint64_t number(int x, int y) const {
    return static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width_) +
           static_cast<std::uint64_t>(x);
  }

 private:
  int width_;
  std::int64_t electrons_;
  double dose_;
  std::uint64_t seed_;
};

}  // namespace surf::mc
