// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/mc/physics/energy_loss_function.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/single_pole.h"

namespace surf::mc {

/// What is known of a material's losses by its energy-loss function.
struct DielectricData {
  EnergyLossFunction elf;
  BandLimits band;
  std::string band_source;             ///< where the band's numbers come from; completes "band: "
};

/// For the materials that come with semsurf, by name; nothing for others. Where no width of the filled band is at hand it is
/// estimated: the Fermi energy of a free-electron gas of the valence electrons.
std::optional<DielectricData> find_dielectric_data(const Material& material);

/// What the screening sum of a complete energy-loss function is: 1, and for an insulator, whose lattice is left out, 1 - 1/n^2
/// with the refractive index n of visible light.
double expected_screening_sum(const Material& material);

}  // namespace surf::mc
