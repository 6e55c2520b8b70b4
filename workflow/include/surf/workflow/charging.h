// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/mc/physics/material.h"
#include "surf/mc/results/simulation_result.h"

namespace surf::workflow {

/// How an insulator would charge. The simulation knows no fields: it tells the balance of a surface
/// that is not charged yet.
struct Charging {
  std::string materials;  ///< the insulators, with commas
  bool all = true;        ///< whether there is no other material
  double leaving = 0;  ///< electrons that leave for good for each primary that meets the specimen
  double current_pa = 0;  ///< of the probe; 0: not said
  double per_nm2 = 0;  ///< net electrons that an image takes from each nm^2, with that current and
                       ///< its dwell time

  /// Positive charge that stays for each primary.
  double net() const { return leaving - 1; }
};

/// Nothing where no material insulates (a gap of 2.5 eV or more), or where no primary met the
/// specimen.
std::optional<Charging> charging_of(const std::vector<mc::Material>& materials,
                                    const mc::SimulationResult& result, const mc::Scan& scan);

/// In a sentence.
std::string describe(const Charging& charging);

}  // namespace surf::workflow
