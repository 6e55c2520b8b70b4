// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

#include "cascades/cascade_format.h"
#include "replay/branch_pose.h"
#include "replay/ledger.h"
#include "replay/surface_query.h"
#include "surf/core/vec3.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {

/// A material as replay takes it.
struct ReplayMaterial {
  const CascadeLibrary* library;  ///< null: direct simulation follows its electrons
  const Medium* medium;
  double barrier_ev;
  bool paid;  ///< whether losses in events pay for secondaries: no cascade can be joined
  EnergyCode code;

  double start_ev(const PackedNode& node) const { return code.decode(node.start.energy); }
  /// At the beginning of a segment.
  double energy_ev(const NodeView& view, int segment) const {
    return code.decode(segment == 0 ? view.node.start.energy
                                    : read_vertex(view.vertex(segment - 1)).energy);
  }
};

/// An electron that is followed along a branch.
template <class State>
struct Branch : BranchPose {
  State state{};
  int material = 0;
  int generation = 0;  ///< 0: the primary
};

/// Where in a branch to begin other than at its start: where its energy falls to this.
struct StartInside {
  double energy_ev;
  Vec3 position;  ///< in the specimen
};

/// What has become of an electron at a segment.
enum class Moved {
  no,        ///< its branch lies as before
  mirrored,  ///< in the flat surroundings' plane
  yes,
  gone  ///< the branch ends here
};

/// A segment of a track as it comes.
struct WalkedSegment {
  const NodeView& view;
  int number;                    ///< in the node
  std::uint64_t before, vertex;  ///< its ends
  float low, high;               ///< their heights, as `Near` says
  const StartInside* inside;     ///< of a segment that is begun inside; else null
};

/// Who follows a walk:
///   medium(material)                      its ReplayMaterial
///   ledger()                              the books of the primary
///   passed(branch, spheres, count, near)  bits of spheres within which nothing happens: not all
///   that there are passes(branch, sphere, near)          whether nothing happens within a sphere;
///   else `near` is what is known there eventful(node, branch, near)          bits of segments that
///   may meet something, or change how the branch lies; of others
///                                         the handler is not told
///   meets(segment, branch, near)          what becomes of the electron on the segment
///   scattered(segment, moved, branch, near)  at its end; whether that changed how the branch lies
template <class H>
concept WalkHandler = requires(H handler, Branch<typename H::State>& branch, Near& near,
                               const WalkedSegment& segment, Moved moved, const NodeView& node,
                               const std::uint64_t* spheres) {
  { handler.medium(0) } -> std::convertible_to<const ReplayMaterial&>;
  { handler.ledger() } -> std::same_as<Ledger&>;
  { handler.passed(branch, spheres, 1, near) } -> std::same_as<unsigned>;
  { handler.eventful(node, branch, near) } -> std::same_as<unsigned>;
  { handler.passes(branch, std::uint64_t{}, near) } -> std::convertible_to<bool>;
  { handler.meets(segment, branch, near) } -> std::same_as<Moved>;
  { handler.scattered(segment, moved, branch, near) } -> std::convertible_to<bool>;
};

/// Walks a stored cascade: an electron from node to node, and at each birth the secondary with all
/// that it generates. Whole nodes that pass what is around them are left out.
template <class Handler>
class CascadeWalker {
 public:
  using State = typename Handler::State;

  explicit CascadeWalker(Handler& handler) : handler_(handler) {}

  /// Follows an electron through a node; false when it is gone. What it then does not generate is
  /// taken off the books.
  bool follow(const std::uint64_t* at, Branch<State>& branch, Near near,
              const StartInside* inside = nullptr) {
    const NodeView view(at);
    branch.scale(view.node.exponent);
    if (view.node.level == 0) return follow_segments(view, branch, near, inside);
    int i = 0;
    if (inside) {
      i = child_at(view, inside->energy_ev, handler_.medium(branch.material));
      for (int k = i + 1; k < view.node.count; ++k)
        handler_.ledger().add(NodeView(view.child(k)).node);
      if (!follow(view.child(i), branch, {}, inside)) return take_off_from(view, i + 1);
      ++i;
    }
    unsigned passed = handler_.passed(branch, view.spheres(), view.node.count, near);
    for (; i < view.node.count; ++i) {
      if (passed >> i & 1) continue;
      Near of_child = near;
      if (handler_.passes(branch, view.spheres()[i], of_child)) continue;
      const int moves = branch.moves, changes = branch.changes;
      if (!follow(view.child(i), branch, of_child)) return take_off_from(view, i + 1);
      if (branch.changes == changes) continue;
      if (branch.moves != moves) near = {};
      near.forget_places();
      passed = handler_.passed(branch, view.spheres(), view.node.count, near);
    }
    return true;
  }

  /// The node below in which the energy falls to this.
  static int child_at(const NodeView& view, double energy_ev, const ReplayMaterial& medium) {
    int i = 0;
    while (i + 1 < view.node.count &&
           medium.start_ev(NodeView(view.child(i + 1)).node) >= energy_ev)
      ++i;
    return i;
  }

  /// The segment in which it does; `count` where rounding has it end before.
  static int segment_at(const NodeView& view, double energy_ev, const ReplayMaterial& medium) {
    int i = 0;
    while (i < view.node.count &&
           medium.code.decode(read_vertex(view.vertex(i)).energy) >= energy_ev)
      ++i;
    return i;
  }

 private:
  bool take_off_from(const NodeView& view, int child) {
    for (; child < view.node.count; ++child)
      handler_.ledger().take_off(NodeView(view.child(child)).node);
    return false;
  }

  bool follow_segments(const NodeView& view, Branch<State>& branch, Near near,
                       const StartInside* inside) {
    const PackedNode& node = view.node;
    const std::uint64_t* const points = view.points();
    const unsigned all = (1u << node.count) - 1;
    unsigned left = all;
    if (inside) {
      const int first = segment_at(view, inside->energy_ev, handler_.medium(branch.material));
      left &= ~0u << first;
      add_births(view, births_before(node, first), branch.material);
    }
    while (left != 0) {  // again after each change of how the branch lies
      const unsigned first = left & -left;
      unsigned eventful = handler_.eventful(view, branch, near);
      if (inside) eventful |= first;
      const int spheres = view.children();
      const unsigned passed =
          spheres > 0 ? handler_.passed(branch, view.spheres(), spheres, near) : 0;
      bool changed = false;
      for (unsigned todo = (eventful | node.births) & left; todo != 0 && !changed;
           todo &= todo - 1) {
        const int i = std::countr_zero(todo);
        if (eventful >> i & 1) {
          const std::uint64_t before = points[i], vertex = points[i + 1];
          const auto height_of = [&](std::uint64_t word) {
            return near.flat ? branch.height_over_plane(word) : branch.height_over_frame(word);
          };
          const WalkedSegment segment{
              view, i, before, vertex, height_of(before), height_of(vertex), inside};
          const Moved moved = handler_.meets(segment, branch, near);
          if (moved == Moved::gone)
            return take_off_births(view, births_before(node, i), branch.material);
          if (moved == Moved::yes) near = {};
          changed = handler_.scattered(segment, moved, branch, near);
          changed |= moved != Moved::no || inside != nullptr;
        }
        if (node.births >> i & 1) {
          const int birth = births_before(node, i);
          if (changed || !(passed >> birth & 1))
            follow_birth(view, birth, branch, points[i + 1], near);
        }
        inside = nullptr;
        if (changed) left &= ~1u << i;
      }
      if (!changed) return true;
    }
    return true;
  }

  static int births_before(const PackedNode& node, int segment) {
    return bits_in(node.births & ((1u << segment) - 1));
  }

  void follow_birth(const NodeView& view, int birth, Branch<State>& parent, std::uint64_t vertex,
                    Near near) {
    if (handler_.passes(parent, view.spheres()[birth], near)) return;
    Branch<State> child{parent.child_at(vertex), parent.state, parent.material,
                        parent.generation + 1};
    follow(view.child(birth), child, near);
  }

  double total_ev(const NodeView& child, int material) const {
    const ReplayMaterial& medium = handler_.medium(material);
    return medium.paid ? 0 : medium.start_ev(child.node) - medium.barrier_ev;
  }

  void add_births(const NodeView& view, int birth, int material) {
    for (; birth < view.children(); ++birth) {
      const NodeView child(view.child(birth));
      handler_.ledger().add(child.node);
      handler_.ledger().add(total_ev(child, material));
    }
  }

  bool take_off_births(const NodeView& view, int birth, int material) {
    for (; birth < view.children(); ++birth) {
      const NodeView child(view.child(birth));
      handler_.ledger().take_off(child.node);
      handler_.ledger().take_off(total_ev(child, material));
    }
    return false;
  }

  Handler& handler_;
};

}  // namespace surf::mc
