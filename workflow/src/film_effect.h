// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/progress.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/sem/film_model.h"

namespace surf::workflow {

/// What is asked about a film.
struct FilmRequest {
  mc::Material film, specimen;
  double energy_ev = 1000;  ///< of the beam
  mc::Physics physics;
  std::int64_t electrons = 20'000;  ///< per plane
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};

/// What a film changes in the yields of SE and BSE, by direct simulation of planes that are tilted
/// by 0 to 80 degrees, without the film and with 2 nm of it. Throws Interrupted, Unsupported.
FilmEffect film_effect(const FilmRequest& request, const std::vector<std::string>& channels,
                       const Watch& watch = {});

}  // namespace surf::workflow
