// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "replay/planar_controls.h"
#include "sampling/unit_worker.h"
#include "surf/mc/cascades/library_size.h"

namespace surf::mc {

/// What the workers of a simulation share: libraries, and planes to compare with.
class PreparedSimulation {
 public:
  /// Scene and options must outlive it. The source alone asks whether it is cancelled: where it
  /// serves several processes, all of them go on or none. Throws Interrupted.
  void prepare(const Scene& scene, const SimulationOptions& options, LibrarySource* source,
               std::int64_t most_primaries, const Watch& watch);

  /// Of each material in each detector, with a wanted accuracy.
  const std::vector<CascadeYield>& yields() const { return yields_; }

  std::unique_ptr<UnitWorker> worker();

  /// Of each material, those that there are; 0 without replay.
  std::size_t cascades() const { return cascades_; }
  /// Planes made so far to compare with; nothing without a wanted accuracy and replay.
  PlanarControls::Made planes_made() const {
    return controls_ ? controls_->made() : PlanarControls::Made{};
  }
  /// How many there will be, from so many pixels of the scan, about, that are looked at.
  std::size_t planes_expected(int pixels) const;

  /// Of all libraries.
  std::size_t library_bytes() const;

 private:
  void get(const Scene& scene, LibrarySource& source, std::size_t wanted, const Watch& watch);
  void measure_yields(int materials);
  bool only_planes() const;
  std::size_t cascades_that_fit(double bytes) const;

  const Scene::Impl* scene_ = nullptr;
  const SimulationOptions* options_ = nullptr;
  std::size_t cascades_ = 0;
  Libraries libraries_;
  std::vector<CascadeYield> yields_;
  std::optional<PlanarControls> controls_;
};

}  // namespace surf::mc
