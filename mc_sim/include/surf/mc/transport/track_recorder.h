// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/core/track.h"
#include "surf/mc/transport/observer.h"

namespace surf::mc {

/// Keeps every track as it happens. Electrons that leave are followed `exit_nm` (>= 0) into the
/// vacuum, so that a picture shows where they go; primaries start as far above the specimen.
class TrackRecorder final : public Observer {
 public:
  explicit TrackRecorder(double exit_nm) : exit_nm_(exit_nm) {}

  void primary(std::int64_t pixel, std::int64_t electron) override;
  void begin_track(int track, int parent, int generation, const Vec3& position_nm,
                   const Vec3& direction, double energy_ev) override;
  void segment(const Vec3& from_nm, const Vec3& to_nm, double energy_from_ev, double energy_to_ev,
               int material) override;
  void end_track(TrackKind end, const Vec3& position_nm, const Vec3& direction,
                 double energy_ev) override;

  std::vector<Track> tracks;  ///< in the order in which they were followed

 private:
  double exit_nm_;
  std::int64_t electron_ = 0;
};

}  // namespace surf::mc
