// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/unit_worker.h"

#include "sampling/adaptive_sampler.h"
#include "sampling/direct_source.h"
#include "sampling/fixed_sampler.h"
#include "sampling/replay_source.h"

namespace surf::mc {
namespace {

template <PrimarySource Source, class... Arguments>
std::unique_ptr<UnitWorker> make_worker(const Scene::Impl& scene, const SimulationOptions& options,
                                        const Arguments&... arguments) {
  if (accuracy_of(options.budget) > 0)
    return std::make_unique<AdaptiveSampler<Source>>(scene, options, arguments...);
  return std::make_unique<FixedSampler<Source>>(scene, options, arguments...);
}

}  // namespace

std::unique_ptr<UnitWorker> make_direct_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options) {
  return make_worker<DirectSource>(scene, options);
}

std::unique_ptr<UnitWorker> make_replay_worker(const Scene::Impl& scene,
                                               const SimulationOptions& options,
                                               const Libraries& libraries,
                                               PlanarControls* controls) {
  return make_worker<ReplaySource>(scene, options, libraries,
                                   accuracy_of(options.budget) > 0 ? controls : nullptr);
}

}  // namespace surf::mc
