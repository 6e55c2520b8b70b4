// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cascade_format.h"
#include "surf/core/track.h"
#include "surf/core/vec3.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::mc {

/// Watches the transport loop in an endless medium and packs one cascade after the other.
class CascadeRecorder {
 public:
  CascadeRecorder(EnergyCode code, double barrier_ev) : code_(code), barrier_ev_(barrier_ev) {}

  void begin_track(int number, int parent, int generation, const Vec3& position, const Vec3&,
                   double energy_ev);
  void segment(const Vec3&, const Vec3& to, double, double energy_to_ev, int);
  void deposit(const Vec3&, const Vec3&, double) {}
  void scattered(bool isotropic) { electrons_[count_ - 1].forgets.back() = isotropic; }
  void end_track(TrackKind, const Vec3&, const Vec3&, double) {}

  /// Packs what was watched since the last call and adds it to `words`.
  void finish(std::vector<std::uint64_t>& words);

 private:
  struct Birth {
    std::size_t vertex, electron;
  };
  struct Electron {
    std::vector<Vec3> points;
    std::vector<double> energies;
    std::vector<char> forgets;      // whether its direction is a new one from this point on
    std::vector<Birth> births;      // last vertex first
    std::size_t unborn = 0;         // vertices before this one may still have a birth
    Box box;                        // of it and all that it generates
  };
  struct Branch;
  struct Content {
    std::uint32_t generated = 0;
    double generated_ev = 0;
    void operator+=(const Content& b) {
      generated += b.generated;
      generated_ev += b.generated_ev;
    }
  };

  // A packed node or branch: where it begins, and the box of its points.
  struct Packed {
    std::size_t word = 0;
    std::size_t first_point = 0, end_point = 0;
    Content content;
  };

  Packed pack_branch(const Electron& electron, const Vec3& origin,
                     std::vector<std::uint64_t>& words);
  Packed pack_node(Branch& branch, std::size_t first_segment, int level,
                   std::vector<std::uint64_t>& words);
  PackedSphere enclose(const Branch& branch, const Packed& packed) const;

  EnergyCode code_;
  double barrier_ev_;
  std::vector<Electron> electrons_;   // reused from cascade to cascade
  std::size_t count_ = 0;
  std::vector<Vec3> unpacked_;        // all points as they will be unpacked, depth first
};

}  // namespace surf::mc
