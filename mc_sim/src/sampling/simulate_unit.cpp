// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/sampling/simulate_unit.h"

#include "geometry/scene_impl.h"
#include "request/check_options.h"
#include "sampling/unit_worker.h"
#include "surf/core/error.h"

namespace surf::mc {
namespace {

void check_unit(const Scan& scan, const WorkUnit& u) {
  if (u.x0 < 0 || u.y0 < 0 || u.x1 > scan.width || u.y1 > scan.height || u.x0 >= u.x1 ||
      u.y0 >= u.y1 || u.electrons < 1 || u.first_electron < 0)
    throw UsageError("unit of work", "it is empty or reaches beyond the scan",
                     "Choose pixels within the scan and at least one electron");
}

}  // namespace

UnitTally simulate_unit(const Scene& scene, const SimulationOptions& options, const WorkUnit& unit,
                        Observer* observer) {
  check_options(options);
  check_unit(scene.scan(), unit);
  SimulationOptions wanted = options;
  wanted.budget = ElectronsPerPixel{unit.first_electron + unit.electrons};
  wanted.method = Method::direct;
  UnitTally out;
  make_direct_worker(scene.impl(), wanted)->simulate(unit, observer, out);
  return out;
}

}  // namespace surf::mc
