// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/core/vec3.h"

namespace surf {

/// How an electron's track ended. SE, BSE and transmitted electrons left the specimen for good.
enum class TrackEnd { absorbed, se, bse, transmitted, lost };

/// The way of one electron.
struct Track {
  int number = 0;                   ///< within its primary's cascade; 0 is the primary
  int parent = -1;                  ///< number of the track that generated it; -1 for the primary
  int generation = 0;               ///< 0 for the primary
  bool secondary = false;
  TrackEnd end = TrackEnd::absorbed;
  std::int64_t electron = 0;        ///< which primary it belongs to
  std::vector<Vec3> points_nm;      ///< at least two
  std::vector<double> energy_ev;    ///< at each point: inside matter from the band's bottom
  std::vector<int> material;        ///< of each segment, one fewer than points; -1 is vacuum
};

}  // namespace surf
