// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "physics/dielectric/loss_sampler.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

// Tables that take a second to make, kept as long as the program runs: media of the same material
// share them. From any thread.

/// What `physics.inelastic_model` makes of the material's energy-loss function.
std::shared_ptr<const LossSampler> kept_losses(const Material& material, const Physics& physics);

/// `measured_reach_nm` of the medium that this is of.
std::vector<double> kept_reach_nm(const Medium& medium, const Material& material,
                                  const Physics& physics);

}  // namespace surf::mc
