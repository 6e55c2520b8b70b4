// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <vector>

#include "surf/core/track.h"

namespace surf::test {

/// A primary that goes down, comes back and leaves, and a secondary of it that stays.
inline std::vector<Track> two_tracks() {
  Track primary;
  primary.kind = TrackKind::bse;
  primary.electron = (std::int64_t{1} << 40) + 7;
  primary.points_nm = {{0, 0, 100}, {0, 0, 0}, {5, 1, -10.1}, {20, 2, 0}, {90, 3, 70}};
  primary.energy_ev = {1000, 1010, 900.5, 880, 870};
  primary.material = {-1, 0, 1, -1};
  Track secondary;
  secondary.number = 1;
  secondary.parent = 0;
  secondary.generation = 1;
  secondary.secondary = true;
  secondary.electron = primary.electron;
  secondary.points_nm = {{5, 1, -10.1}, {6, 1, -10.1}};
  secondary.energy_ev = {12, 0};
  secondary.material = {1};
  return {primary, secondary};
}

/// Random walks below z = 0 with ends of every kind.
inline std::vector<Track> random_walks(int count) {
  std::mt19937 random(5);
  const auto uniform = [&] { return (random() / 4294967296.0 - 0.5) * 2; };
  std::vector<Track> tracks;
  for (int i = 0; i < count; ++i) {
    Track track;
    track.electron = i / 2;
    track.number = i % 2;
    track.secondary = i % 2 == 1;
    track.kind = static_cast<TrackKind>(i % 5);
    track.points_nm = {{0, 0, 50}, {0, 0, 0}};
    for (int step = 0; step < 60; ++step) {
      const Vec3 p = track.points_nm.back();
      track.points_nm.push_back(
          {p.x + 6 * uniform(), p.y + 6 * uniform(), p.z + 5 * uniform() - 1.2});
    }
    track.energy_ev.assign(track.points_nm.size(), 500);
    track.material.assign(track.points_nm.size() - 1, 0);
    track.material[0] = -1;
    tracks.push_back(track);
  }
  return tracks;
}

}  // namespace surf::test
