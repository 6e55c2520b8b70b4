// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/track_recorder.h"

namespace surf::mc {

void TrackRecorder::primary(std::int64_t, std::int64_t electron) { electron_ = electron; }

void TrackRecorder::begin_track(int number, int parent, int generation, const Vec3& position,
                                const Vec3&, double energy) {
  Track track;
  track.number = number;
  track.parent = parent;
  track.generation = generation;
  track.secondary = generation > 0;
  track.electron = electron_;
  track.points_nm.push_back(position);
  track.energy_ev.push_back(energy);
  tracks.push_back(std::move(track));
}

void TrackRecorder::segment(const Vec3& from, const Vec3& to, double, double energy, int material) {
  Track& track = tracks.back();
  // The first way through vacuum starts wherever the gun is: cut it short.
  if (track.points_nm.size() == 1 && material < 0 && track.number == 0) {
    const Vec3 way = to - from;
    const double all = length(way);
    if (all > exit_nm_) track.points_nm[0] = to - way * (exit_nm_ / all);
  }
  track.points_nm.push_back(to);
  track.energy_ev.push_back(energy);
  track.material.push_back(material);
}

void TrackRecorder::end_track(TrackKind end, const Vec3& position, const Vec3& direction,
                              double energy) {
  Track& track = tracks.back();
  track.kind = end;
  const bool left = end == TrackKind::se || end == TrackKind::bse || end == TrackKind::transmitted;
  if (!left && track.points_nm.size() > 1) return;
  // A track that stops where it starts is a line of no length.
  track.points_nm.push_back(left ? position + direction * exit_nm_ : position);
  track.energy_ev.push_back(energy);
  track.material.push_back(-1);
}

}  // namespace surf::mc
