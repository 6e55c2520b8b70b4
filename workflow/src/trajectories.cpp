// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "extras.h"
#include "surf/core/units.h"
#include "surf/mc/track_recorder.h"

namespace surf::workflow {

void write_trajectories(const mc::Scene&, const SimulateJob&,
                        const std::map<std::string, std::string>&) {}

}  // namespace surf::workflow
