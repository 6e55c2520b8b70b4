// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/plot.h"
#include "surf/mc/physics/material.h"

namespace surf::workflow {

/// What is known of a material's losses and scattering, from 20 eV to 30 keV above the vacuum level: its energy-loss function,
/// free paths and losses per length. Of materials without an energy-loss function (mc::find_dielectric_data) what simulations
/// use alone.
io::Plot plot_material(const mc::Material& material);

}  // namespace surf::workflow
