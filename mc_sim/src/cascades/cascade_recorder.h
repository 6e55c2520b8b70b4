// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cascades/cascade_format.h"
#include "surf/core/track.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// Watches the transport loop in an endless medium and packs one cascade after the other.
class CascadeRecorder {
 public:
  /// `paid`: whether electrons pay for the secondaries that they make, so that these bring no
  /// energy of their own.
  CascadeRecorder(EnergyCode code, double barrier_ev, bool paid)
      : code_(code), barrier_ev_(barrier_ev), paid_(paid) {}

  void begin_track(int number, int parent, int generation, const Vec3& position, const Vec3&,
                   double energy_ev);
  void segment(const Vec3&, const Vec3& to, double, double energy_to_ev, int) {
    points_.push_back({to, energy_to_ev, false});
  }
  void deposit(const Vec3&, const Vec3&, double) {}
  void scattered(bool isotropic, double energy_ev) {
    points_.back().forgets = isotropic;
    points_.back().energy_ev = energy_ev;
  }
  void end_track(TrackKind, const Vec3&, const Vec3&, double) {}

  /// Packs what was watched since the last call and adds it to `words`.
  void finish(std::vector<std::uint64_t>& words);

 private:
  struct Point {
    Vec3 position;
    double energy_ev;
    bool forgets;  // whether its direction is a new one from this point on
  };
  // Electrons are followed one after the other: each one's points are a piece of all.
  struct Electron {
    std::size_t first, end;  // of its points
    std::size_t unborn;      // vertices before this one may still have a birth
    std::size_t birth;       // the vertex of its parent that it starts from
    int parent;
    int first_child, next;  // its first to be born; the next of the same parent
    Box box;                // of it and all that it generates
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

  // What encloses a node or branch: those in it follow it, up to `end`.
  struct Bound {
    Vec3 center;
    double radius_nm;
    std::size_t first_point, end_point;  // its own
    std::size_t end;
  };

  // A packed node or branch.
  struct Packed {
    std::size_t word;  // where it begins
    std::size_t bound;
    Box box;
    Content content;
  };

  void measure();
  Packed pack_branch(const Electron& electron, const Vec3& origin,
                     std::vector<std::uint64_t>& words);
  Packed pack_node(Branch& branch, std::size_t first_segment, int level,
                   std::vector<std::uint64_t>& words);
  PackedSphere enclose(const Branch& branch, const Packed& packed);
  double farthest(const Vec3& center, std::size_t bound) const;

  EnergyCode code_;
  double barrier_ev_;
  bool paid_;
  // Reused from cascade to cascade.
  std::vector<Electron> electrons_;
  std::vector<Point> points_;           // once packed, as they will be unpacked
  std::vector<PackedVertex> vertices_;  // of the points, once packed
  std::vector<Bound> bounds_;           // depth first
};

}  // namespace surf::mc
