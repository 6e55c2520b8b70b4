// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "cascades/cascade_format.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// A straight piece of an electron's way in a cascade.
struct CascadeSegment {
  Vec3 from, to;  // nm
  double energy_from_ev, energy_to_ev;
  bool primary;
  bool first;  // of its electron
};

/// Tells a visitor of a packed cascade: `segment(const CascadeSegment&)` for each piece of each
/// electron, and `stop(position, primary)` where an electron ends. A secondary comes between the
/// pieces of its parent.
template <class Visitor>
class CascadeWalk {
 public:
  CascadeWalk(const EnergyCode& code, Visitor& visitor) : code_(code), visitor_(visitor) {}

  void walk(const std::uint64_t* words) { branch(words, {}, true); }

 private:
  struct Way {
    Vec3 origin, at;
    double unit_nm, energy_ev;
    bool primary, first;
  };

  Vec3 place(const Way& way, std::uint64_t word) const {
    const PackedVertex v = read_vertex(&word);
    return way.origin + Vec3{double(v.x), double(v.y), double(v.z)} * way.unit_nm;
  }

  void branch(const std::uint64_t* words, const Vec3& origin, bool primary) {
    const PackedNode root = read_node(words);
    Way way{origin,  origin, power_of_two(root.exponent), code_.decode(root.start.energy),
            primary, true};
    node(words, way);
    visitor_.stop(way.at, primary);
  }

  void node(const std::uint64_t* words, Way& way) {
    const NodeView view(words);
    if (view.node.level > 0) {
      for (int i = 0; i < view.node.count; ++i) node(view.child(i), way);
      return;
    }
    int birth = 0;
    for (int i = 0; i < view.node.count; ++i) {
      const std::uint64_t vertex = *view.vertex(i);
      const Vec3 to = place(way, vertex);
      const double energy_ev = code_.decode(read_vertex(&vertex).energy);
      visitor_.segment({way.at, to, way.energy_ev, energy_ev, way.primary, way.first});
      way.at = to, way.energy_ev = energy_ev, way.first = false;
      if (view.node.births & 1u << i) branch(view.child(birth++), to, false);
    }
  }

  const EnergyCode& code_;
  Visitor& visitor_;
};

}  // namespace surf::mc
