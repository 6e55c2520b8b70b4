// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Retraces stored cascades in a specimen. The medium is isotropic and does not remember, so a
// surface acts on the rest of a cascade as a rigid motion: a reflection mirrors it, a way out and
// back in turns and moves it. Statistically nothing distinguishes it from transport.h.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/rotation.h"
#include "replay/branch_pose.h"
#include "replay/cascade_walker.h"
#include "replay/ledger.h"
#include "replay/replay_random.h"
#include "replay/surface_query.h"
#include "surf/core/vec3.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/physics/barrier.h"
#include "surf/mc/transport/tally.h"
#include "transport/detection.h"
#include "transport/random_streams.h"
#include "transport/transport.h"

namespace surf::mc {

template <GeometryWithKnownFaces G>
class Replay {
 public:
  using State = typename G::State;
  using Surface = typename G::Surface;
  using Direct = Transport<G, NoObserver>;

  /// `libraries` by material, each starting at the beam's energy plus the material's barrier; where
  /// one is missing (null), `direct` follows the electrons. `watch_turns`: whether detectors ask
  /// for what was generated before the primary turned back.
  Replay(G& geometry, const std::vector<const Medium*>& media,
         const std::vector<const CascadeLibrary*>& libraries, BarrierModel barrier,
         bool watch_turns, Direct& direct, Detection& detection, Balance& balance)
      : geometry_(geometry), query_(geometry), barrier_(barrier), watch_turns_(watch_turns),
        direct_(direct), detection_(detection), balance_(balance), ledger_(balance),
        walker_(*this) {
    for (std::size_t i = 0; i < media.size(); ++i) {
      const CascadeLibrary* l = libraries[i];
      materials_.push_back({l, media[i], media[i]->barrier_ev(), media[i]->loses_in_events(),
                            EnergyCode(media[i]->cutoff_ev(), l ? l->settings().start_energy_ev
                                                                : 2 * max_beam_energy_ev)});
    }
  }
  Replay(const Replay&) = delete;  // the walker refers to it

  /// A primary that comes through vacuum. Where it enters the specimen it becomes a cascade of the
  /// material's library. True if it met the specimen.
  bool run(const Vec3& start, const Vec3& direction, double energy_ev, State state,
           const ReplayedPrimary& primary) {
    begin(direction, energy_ev, primary);
    Free electron{start, direction, energy_ev, state};
    if (fly(electron, 0)) enter(electron, surface_.normal);
    ledger_.end(hit_);
    return hit_;
  }

  /// The same for a primary known to have come as far as `surface`, through `state`.
  void run_from(const Surface& surface, const Vec3& direction, double energy_ev, State state,
                const ReplayedPrimary& primary) {
    begin(direction, energy_ev, primary);
    hit_ = true;
    Free electron{surface.position, direction, energy_ev, state};
    if (pass(electron, surface, 0)) enter(electron, surface.normal);
    else if (fly(electron, 0)) enter(electron, surface_.normal);
    ledger_.end(hit_);
  }

  /// What is known of the surface around the next primaries; it changes nothing but time. `patch`:
  /// null, or one that stays until the next call.
  void surroundings(const FlatSurroundings<State>& flat, const LocalSurface* patch = nullptr) {
    query_.at(flat, patch);
    // Nothing is reflected for certain where the barrier is off: it has no step then.
    flat_step_ev_ = flat.radius > 0 ? barrier_of(geometry_.material(flat.inside)) -
                                          barrier_of(geometry_.material(flat.outside))
                                    : 0;
  }

  /// Whether a surface that lies a little otherwise shall change fates little, so that they can be
  /// compared with those on a plane. It costs time, and changes no statistics.
  void use_common_random_numbers(bool common) { common_random_numbers_ = common; }

  /// A primary with this cascade will come soon, and enter this material.
  void fetch(int material, std::size_t cascade) const {
    const CascadeLibrary* library = materials_[static_cast<std::size_t>(material)].library;
    if (library) library->fetch(cascade);
  }

  // What the walk asks of its handler.

  const ReplayMaterial& medium(int material) const {
    return materials_[static_cast<std::size_t>(material)];
  }
  Ledger& ledger() { return ledger_; }

  bool passes(Branch<State>& branch, std::uint64_t sphere, Near& near) const {
    return query_.misses(branch, branch.state, sphere, near) && !watching(branch);
  }

  unsigned passed(const Branch<State>& branch, const std::uint64_t* spheres, int count,
                  const Near& near) const {
    return watching(branch) ? 0 : query_.clear_of(branch, spheres, count, near);
  }

  unsigned eventful(const NodeView& node, const Branch<State>& branch, const Near& near) const {
    const int segments = node.node.count;
    if (watching(branch) || (branch.deflected && common_random_numbers_))
      return (1u << segments) - 1;
    return query_.may_meet(branch, node.points(), segments, near);
  }

  Moved meets(const WalkedSegment& s, Branch<State>& branch, const Near& near) {
    if (near.flat) {
      if (watching(branch)) note_turn(branch.point(s.vertex) - branch.point(s.before));
      return s.high > 0 ? cross_plane(s, branch) : Moved::no;
    }
    if (!watching(branch) && !s.inside && near.band.is_beside(s.low, s.high)) return Moved::no;
    const Float4 from =
        s.inside ? float4(query_.frame().in(s.inside->position)) : branch.point(s.before);
    const Float4 way = branch.point(s.vertex) - from;
    if (watching(branch)) note_turn(way);
    if (query_.is_clear(from, way)) return Moved::no;
    const double energy =
        s.inside ? s.inside->energy_ev : medium(branch.material).energy_ev(s.view, s.number);
    random_.at(event(s));
    return cross_segment(from, way, energy, branch, true);
  }

  bool scattered(const WalkedSegment& s, Moved moved, Branch<State>& branch, Near& near) {
    if (moved != Moved::no && watching(branch))
      note_turn(branch.point(s.vertex) - branch.point(s.before));
    if (!branch.deflected || !common_random_numbers_ || !EnergyCode::forgets(s.vertex))
      return false;
    branch.resample_direction(home_, s.vertex, query_.plane());
    if (!query_.flat().whole || branch.left_ball) {  // what comes may leave the surroundings
      ++branch.moves;
      near = {};
    }
    return true;
  }

 private:
  // An electron without a track: in vacuum, or just inside.
  struct Free {
    Vec3 position;
    Vec3 direction;
    double energy;
    State state;
  };

  void begin(const Vec3& direction, double energy_ev, const ReplayedPrimary& primary) {
    beam_ = direction;
    primary_ = primary;
    random_.begin(primary);
    hit_ = false;
    turned_ = false;
    joined_ = 0;
    handed_over_ = 0;
    ledger_.begin(energy_ev);
  }

  double barrier_of(int material) const { return material < 0 ? 0.0 : medium(material).barrier_ev; }

  // Through vacuum until it is inside; false when it is gone.
  bool fly(Free& e, int generation) {
    for (;;) {
      ++balance_.steps;
      if (hit_ && geometry_.flies_free(e.position, e.direction)) return escape(e, generation > 0);
      ++balance_.rays;
      const Crossing met = geometry_.crossing(
          e.position, e.direction, std::numeric_limits<double>::infinity(), e.state, surface_);
      if (met == Crossing::wrong_side) return lose(LossCause::wrong_side, e.energy);
      if (met == Crossing::none) return escape(e, generation > 0);
      hit_ = true;
      e.position = surface_.position;
      if (pass(e, surface_, generation)) return true;
    }
  }

  // At a surface: true if the electron is in matter afterwards.
  bool pass(Free& e, const Surface& surface, int generation) {
    const double step = barrier_of(geometry_.material(e.state)) -
                        barrier_of(geometry_.material(surface.state_ahead));
    if (cross_barrier(barrier_, surface.normal, step, e.direction, e.energy, random_)) {
      e.state = surface.state_ahead;
      e.position = surface.position_ahead;
    }
    if (generation == 0 && dot(e.direction, beam_) < 0) turned_ = true;
    return geometry_.material(e.state) >= 0;
  }

  // A hair inside: where the first scattering is packed into the very point of entry, and that lies
  // on an edge, what starts there could leave unseen between two faces.
  void enter(const Free& e, const Vec3& normal) {
    const int material = geometry_.material(e.state);
    const CascadeLibrary* library = medium(material).library;
    if (!library) return hand_over(e, 0);
    const std::uint64_t* root = library->cascade(primary_.cascade).data();
    cascade_begin_ = root;
    const Vec3 here = e.position + normal * (dot(normal, e.direction) > 0 ? inside_nm : -inside_nm);
    query_.enter(here);
    const Frame& frame = query_.frame();
    ledger_.add(NodeView(root).node);
    Branch<State> branch;
    home_ = rotation_in(frame, beam_frame(e.direction, primary_.azimuth));
    beam_in_ = float4(frame.direction_in(beam_));
    branch.origin = float4(frame.in(here));
    branch.scaled = home_;
    branch.state = e.state;
    branch.material = material;
    branch.left_ball = squared_length(branch.origin - query_.plane().point) > here_nm * here_nm;
    branch.note_change();
    walker_.follow(root, branch, {});
  }

  void note_turn(const Float4& way) {
    const Float4 along = way * beam_in_;
    if (along[0] + along[1] + along[2] < 0) turned_ = true;
  }

  bool watching(const Branch<State>& branch) const {
    return watch_turns_ && branch.generation == 0 && !turned_;
  }

  // What random numbers at the end of this segment go by.
  std::uint32_t event(const WalkedSegment& s) const {
    return static_cast<std::uint32_t>(s.view.vertex(s.number) - cascade_begin_) +
           (static_cast<std::uint32_t>(joined_) << 16);
  }

  // A segment that leaves the flat surroundings' matter, from below the plane (`low`, a rounding
  // aside) to above it (`high`).
  Moved cross_plane(const WalkedSegment& s, Branch<State>& branch) {
    double energy = medium(branch.material).energy_ev(s.view, s.number);
    const double rise = s.high - s.low;
    const Float4 units = coordinates(s.vertex) - coordinates(s.before);
    const double unit = power_of_two(branch.exponent);
    const double squared = squared_length(units) * unit * unit;
    // Total reflection with the energy at the segment's start is total reflection.
    if (energy * rise * rise <= flat_step_ev_ * squared) {
      branch.mirror_in(query_.plane());
      return Moved::mirrored;
    }
    random_.at(event(s));
    const Frame& frame = query_.frame();
    const FlatSurroundings<State>& flat = query_.flat();
    const double share = std::clamp(static_cast<double>(-s.low) / rise, 0.0, 1.0);
    const Float4 from = branch.point(s.before);
    const double whole = std::sqrt(squared);
    // Of unit length to the last bit, or `move` would mirror what goes on straight.
    const Vec3 direction = normalized(frame.direction_out(vec3(branch.scaled(units))));
    Vec3 met_at = frame.out(vec3(from)) + direction * (share * whole);
    met_at -= flat.normal * dot(met_at - flat.point, flat.normal);
    surface_.distance = share * whole;
    surface_.position = surface_.position_ahead = met_at;
    surface_.normal = flat.normal;
    surface_.state_ahead = flat.outside;
    energy = medium(branch.material).medium->energy_after(energy, surface_.distance);
    Free e{met_at, direction, energy, branch.state};
    if (pass(e, surface_, branch.generation)) {
      if (e.state == branch.state) {
        branch.mirror_in(query_.plane());
        return Moved::mirrored;
      }
    } else if (!fly(e, branch.generation)) {
      return Moved::gone;
    }
    branch.left_ball = true;
    if (geometry_.material(e.state) != branch.material) {
      join(e, branch.generation);
      return Moved::gone;
    }
    move(branch, direction, met_at, e);
    const double left = whole - share * whole;
    if (left > 0 &&
        cross_segment(float4(frame.in(e.position)), float4(frame.direction_in(e.direction) * left),
                      e.energy, branch, false) == Moved::gone)
      return Moved::gone;
    return Moved::yes;
  }

  // The rest of the branch goes on from where the electron is, in its direction.
  void move(Branch<State>& branch, const Vec3& direction, const Vec3& met_at, const Free& e) const {
    const Frame& frame = query_.frame();
    branch.move(turn(frame.direction_in(direction), frame.direction_in(e.direction)),
                float4(frame.in(met_at)), float4(frame.in(e.position)));
    branch.state = e.state;
  }

  // A segment that may meet surfaces. What happens there moves the rest of the branch.
  Moved cross_segment(const Float4& start, const Float4& way, double energy, Branch<State>& branch,
                      bool asked) {
    const Frame& frame = query_.frame();
    Vec3 from = frame.out(vec3(start));
    Vec3 direction = frame.direction_out(vec3(way));
    double left = length(direction);
    if (!(left > 0)) return Moved::no;
    direction *= 1.0 / left;
    const ReplayMaterial& m = medium(branch.material);
    Moved moved = Moved::no;
    for (int bounces = 0;; ++bounces) {
      const Crossing met = query_.first_crossing(from, direction, left, branch.state, surface_,
                                                 asked && bounces == 0, balance_.rays);
      if (met == Crossing::none) return moved;
      if (met == Crossing::wrong_side || bounces > most_bounces) {
        lose(met == Crossing::wrong_side ? LossCause::wrong_side : LossCause::too_many_steps,
             energy - m.barrier_ev);
        return Moved::gone;
      }
      energy = m.medium->energy_after(energy, surface_.distance);
      left -= surface_.distance;
      const Vec3 met_at = surface_.position;
      Free e{met_at, direction, energy, branch.state};
      if (!pass(e, surface_, branch.generation)) {
        if (!fly(e, branch.generation)) return Moved::gone;
        branch.left_ball = true;
      }
      if (geometry_.material(e.state) != branch.material) {
        join(e, branch.generation);
        return Moved::gone;
      }
      move(branch, direction, met_at, e);
      from = e.position;
      direction = e.direction;
      energy = e.energy;
      moved = Moved::yes;
      if (!(left > 0)) return moved;
    }
  }

  // Goes on with a track of the material's library where its energy is the electron's, turned to
  // its direction: exact, where energy falls by continuous loss alone.
  void join(const Free& e, int generation) {
    const int material = geometry_.material(e.state);
    const ReplayMaterial& m = medium(material);
    if (!m.library || m.paid) return hand_over(e, generation);
    if (e.energy <= m.medium->cutoff_ev()) return;
    if (++joined_ > most_joined) {
      lose(LossCause::too_many_steps, e.energy - m.barrier_ev);
      return;
    }
    const std::uint64_t* root =
        m.library
            ->cascade(static_cast<std::size_t>(random_.uniform() *
                                               static_cast<double>(m.library->cascades())))
            .data();
    NodeView leaf(root);
    while (leaf.node.level > 0) leaf = NodeView(leaf.child(walker_.child_at(leaf, e.energy, m)));
    const int segment = walker_.segment_at(leaf, e.energy, m);
    if (segment == leaf.node.count) return;  // within rounding of the cutoff, where tracks end
    const float unit = power_of_two(leaf.node.exponent);
    const std::uint64_t before =
        segment == 0 ? std::bit_cast<std::uint64_t>(leaf.node.start) : *leaf.vertex(segment - 1);
    const Vec3 a = vec3(coordinates(before) * unit);
    const Vec3 way = vec3(coordinates(*leaf.vertex(segment)) * unit) - a;
    const double whole = length(way);
    const Vec3 along = whole > 0 ? way * (1 / whole) : Vec3{0, 0, -1};
    const double done =
        m.medium->range_nm(m.energy_ev(leaf, segment)) - m.medium->range_nm(e.energy);
    const Vec3 begin = a + along * std::clamp(done, 0.0, whole);
    const Frame& frame = query_.frame();
    Branch<State> branch;
    const Rotation before_joining = home_;
    home_ =
        rotation_in(frame, beam_frame(e.direction, random_.uniform())) * turn(along, {0, 0, -1});
    branch.scaled = home_;
    branch.origin = float4(frame.in(e.position)) - branch.scaled(float4(begin));
    branch.state = e.state;
    branch.material = material;
    branch.generation = generation;
    branch.left_ball = true;
    branch.note_change();
    const std::uint64_t* const cascade = cascade_begin_;
    cascade_begin_ = root;
    const StartInside inside{e.energy, e.position};
    walker_.follow(root, branch, {}, &inside);
    cascade_begin_ = cascade;
    home_ = before_joining;
  }

  // A material without a library, or with one that has no track of this energy: direct simulation
  // follows the electron and all that it generates.
  void hand_over(const Free& e, int generation) {
    const double total_ev = e.energy - barrier_of(geometry_.material(e.state));
    if (handed_over_ == random_streams::most_handed_over) {
      lose(LossCause::too_many_steps, total_ev);
      return;
    }
    ledger_.hand_over(total_ev);
    RandomStream random(primary_.seed, primary_.pixel,
                        random_streams::handed_over(primary_.electron, handed_over_++));
    direct_.take_over({e.position, e.direction, e.energy, e.state, generation, -1, turned_}, beam_,
                      random);
  }

  bool escape(const Free& e, bool secondary) {
    ledger_.escape(e.energy);
    count_escape(balance_, e.energy, e.direction, hit_);
    if (hit_) detection_.escaped({e.energy, e.direction, secondary, turned_});
    return false;
  }

  bool lose(LossCause cause, double total_ev) {
    ledger_.lose(cause, total_ev);
    return false;
  }

  static constexpr double here_nm = 0.01;  // nearer than this, two places are one
  static constexpr double inside_nm = 1e-4;
  static constexpr int most_bounces = 1000;
  static constexpr int most_joined = 2000;

  G& geometry_;
  SurfaceQuery<G> query_;
  BarrierModel barrier_;
  bool watch_turns_;
  Direct& direct_;
  Detection& detection_;
  Balance& balance_;
  std::vector<ReplayMaterial> materials_;
  Surface surface_;  // scratch
  double flat_step_ev_ = 0;
  bool common_random_numbers_ = false;

  // Of the current primary:
  Ledger ledger_;
  CascadeWalker<Replay> walker_;
  ReplayedPrimary primary_;
  ReplayRandom random_;
  Vec3 beam_;
  Float4 beam_in_{};  // in the frame
  Rotation home_;     // how the cascade lay when it entered
  bool hit_ = false;
  bool turned_ = false;
  int joined_ = 0;
  const std::uint64_t* cascade_begin_ = nullptr;
  std::uint64_t handed_over_ = 0;
};

}  // namespace surf::mc
