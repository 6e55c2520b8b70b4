// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/track.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {

const char* name_of(TrackKind kind) {
  switch (kind) {
    case TrackKind::absorbed:
      return "absorbed";
    case TrackKind::se:
      return "se";
    case TrackKind::bse:
      return "bse";
    case TrackKind::transmitted:
      return "transmitted";
    case TrackKind::lost:
      return "lost";
  }
  return "lost";
}

void validate(const Track& track, const char* subject) {
  const auto refuse = [&](const std::string& reason) {
    throw InvalidInput(
        subject, fmt::format("track {} of electron {}: {}", track.number, track.electron, reason),
        "Record every point with its energy and every piece with its material");
  };
  const std::size_t points = track.points_nm.size();
  if (points < 2) refuse(fmt::format("{} points make no path", points));
  if (track.energy_ev.size() != points) {
    refuse(fmt::format("{} energies for {} points", track.energy_ev.size(), points));
  }
  if (track.material.size() != points - 1) {
    refuse(fmt::format("{} materials for {} pieces", track.material.size(), points - 1));
  }
  for (std::size_t i = 0; i < points; ++i) {
    if (!is_finite(track.points_nm[i])) refuse(fmt::format("point {} is not finite", i));
    if (!(track.energy_ev[i] >= 0) || !std::isfinite(track.energy_ev[i])) {
      refuse(fmt::format("the energy at point {} is {} eV", i, track.energy_ev[i]));
    }
  }
}

}  // namespace surf
