// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/mc/physics/material.h"
#include "surf/mc/results/simulation_result.h"

namespace surf::workflow {

/// How an insulator would charge. The simulation knows no electric fields: it gives the charge
/// balance of a surface that is not charged yet.
struct Charging {
  std::string materials;  ///< names of the insulators, separated by commas
  bool all = true;        ///< there is no other material
  double leaving = 0;     ///< electrons that leave for good, per primary that meets the specimen
  double current_pa = 0;  ///< probe current; 0: unknown
  /// Net electrons that one image takes from each nm^2, with that current and its dwell time.
  double per_nm2 = 0;

  /// Positive charge that stays, per primary.
  double net() const { return leaving - 1; }
};

/// Computes the charge balance. Returns nothing if no material insulates (a gap of 2.5 eV or more),
/// or if no primary met the specimen.
std::optional<Charging> charging_of(const std::vector<mc::Material>& materials,
                                    const mc::SimulationResult& result, const mc::Scan& scan);

/// The balance in a sentence.
std::string describe(const Charging& charging);

}  // namespace surf::workflow
