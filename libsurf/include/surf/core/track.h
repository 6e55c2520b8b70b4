// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/core/vec3.h"

namespace surf {

/// How the path of an electron ended: absorbed in the specimen; detected as a secondary (below 50
/// eV) or backscattered electron; transmitted through the far side; or lost, because it was not
/// followed to its end.
enum class TrackKind { absorbed, se, bse, transmitted, lost };

/// The path of one electron through vacuum and specimen, from its beginning to its end.
struct Track {
  int number = 0;          ///< among the tracks of the same primary, from 0 (the primary itself)
  int parent = -1;         ///< number of the track that generated this one; -1: none
  int generation = 0;      ///< 0: a primary
  bool secondary = false;  ///< liberated in the specimen, not from the beam
  TrackKind kind = TrackKind::absorbed;
  std::int64_t electron = 0;      ///< the number of its primary
  std::vector<Vec3> points_nm;    ///< two or more, in the order of flight
  std::vector<double> energy_ev;  ///< at each point, >= 0
  std::vector<int> material;  ///< of each straight piece, points_nm.size() - 1 numbers; -1: vacuum
};

/// "absorbed", "se", "bse", "transmitted", "lost".
const char* name_of(TrackKind kind);

/// Throws InvalidInput (naming `subject`) if the lengths do not match or a number is not finite.
void validate(const Track& track, const char* subject = "track");

}  // namespace surf
