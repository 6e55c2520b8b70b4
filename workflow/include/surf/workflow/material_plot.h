// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/progress.h"
#include "surf/io/plot.h"
#include "surf/mc/physics/material.h"

namespace surf::workflow {

struct MaterialPlotOptions {
  std::int64_t electrons = 4000;  ///< primaries per yield
  int threads = 0;
  Watch watch;
};

/// Plots a material's losses and scattering from 20 eV to 30 keV above the vacuum level: its
/// energy-loss function, free paths and losses per length in both tiers of physics, and the
/// simulated yields of a plane. Throws Interrupted.
io::Plot plot_material(const mc::Material& material, const MaterialPlotOptions& options = {});

}  // namespace surf::workflow
