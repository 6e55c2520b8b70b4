// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Retraces stored cascades in a specimen. The medium is isotropic and does not remember, so a surface
// acts on the rest of a cascade as a rigid motion: a reflection mirrors it, a way out and back in
// turns and moves it. Statistically nothing distinguishes it from transport.h, whose Geometry it
// shares.

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "cascade_format.h"
#include "detection.h"
#include "replay_random.h"
#include "rotation.h"
#include "surf/core/vec3.h"
#include "surf/mc/barrier.h"
#include "surf/mc/cascade_library.h"
#include "surf/mc/tally.h"
#include "surface_patch.h"
#include "transport.h"

namespace surf::mc {

/// x, y, z of a packed vertex or sphere.
inline Float4 coordinates(std::uint64_t word) {
  using Short4 = std::int16_t __attribute__((vector_size(8)));
  return __builtin_convertvector(std::bit_cast<Short4>(word), Float4);
}

/// A ball around a point of the surface in which all surface lies in one plane, with matter on one
/// side and nothing but that matter within the ball.
template <class State>
struct FlatSurroundings {
  Vec3 point;          ///< on the plane: the ball's centre
  Vec3 normal;         ///< unit, out of the matter
  double radius = 0;   ///< 0: nothing is known
  bool whole = false;  ///< the ball holds all that starts at the point and stays inside
  State inside{};      ///< of the matter
  State outside{};
};

template <class Geometry>
class Replay {
 public:
  using State = typename Geometry::State;

  using Direct = Transport<Geometry, NoObserver>;

  /// `libraries` by material, each starting at the beam's energy plus the material's barrier; where
  /// one is missing (null), `direct` follows the electrons. `watch_turns`: whether detectors ask for
  /// what was generated before the primary turned back.
  Replay(Geometry& geometry, const std::vector<const Medium*>& media,
         const std::vector<const CascadeLibrary*>& libraries, BarrierModel barrier,
         bool watch_turns, Direct& direct, Detection& detection, Balance& balance)
      : geometry_(geometry), barrier_(barrier), watch_turns_(watch_turns), direct_(direct),
        detection_(detection), balance_(balance) {
    for (std::size_t i = 0; i < media.size(); ++i) {
      const CascadeLibrary* l = libraries[i];
      media_.push_back({l, media[i], media[i]->barrier_ev(),
                        EnergyCode(media[i]->cutoff_ev(),
                                   l ? l->settings().start_energy_ev : 2 * max_beam_energy_ev)});
    }
  }

  /// A primary that comes through vacuum. Where it enters the specimen it becomes a cascade of the
  /// material's library. True if it met the specimen.
  bool run(const Vec3& start, const Vec3& direction, double energy_ev, State state,
           const ReplayedPrimary& primary) {
    begin(direction, energy_ev, primary);
    Free electron{start, direction, energy_ev, state};
    if (fly(electron, 0)) enter(electron, surface_.normal);
    end();
    return hit_;
  }

  /// The same for a primary known to have come as far as `surface`, through `state`.
  void run_from(const typename Geometry::Surface& surface, const Vec3& direction, double energy_ev,
                State state, const ReplayedPrimary& primary) {
    begin(direction, energy_ev, primary);
    hit_ = true;
    Free electron{surface.position, direction, energy_ev, state};
    if (pass(electron, surface, 0)) enter(electron, surface.normal);
    else if (fly(electron, 0)) enter(electron, surface_.normal);
    end();
  }

  /// What is known of the surface around the next primaries; it changes nothing but time. `patch`:
  /// null, or one that stays until the next call.
  void surroundings(const FlatSurroundings<State>& flat, const SurfacePatch* patch = nullptr) {
    flat_ = flat;
    patch_ = patch;
    frame_ = patch ? patch->frame() : Frame{};
    flat_normal_ = float4(frame_.direction_in(flat.normal));
    // Nothing is reflected for certain where the barrier is off: it has no step then.
    flat_step_ev_ = flat.radius > 0 ? barrier_of(geometry_.material(flat.inside)) -
                                          barrier_of(geometry_.material(flat.outside))
                                    : 0;
  }

  /// Whether a surface that lies a little otherwise shall change fates little, so that they can be
  /// compared with those on a plane. It costs time, and changes no statistics.
  void steady(bool steady) { steady_ = steady; }

  /// A primary with this cascade will come soon, and enter this material.
  void fetch(int material, std::size_t cascade) const {
    const CascadeLibrary* library = media_[static_cast<std::size_t>(material)].library;
    if (library) library->fetch(cascade);
  }

 private:
  struct Packed {
    const CascadeLibrary* library;
    const Medium* medium;
    double barrier_ev;
    EnergyCode code;
  };

  // An electron without a track: in vacuum, or just inside.
  struct Free {
    Vec3 position;
    Vec3 direction;
    double energy;
    State state;
  };

  // An electron that is followed along its branch, in `frame_`.
  struct Branch {
    Float4 origin{};     // its first point
    Rotation scaled;     // from the branch's coordinates, nm
    Float4 height{};     // above the flat surroundings' plane: of the coordinates, and of the origin
    Float4 rise{};       // the same along the frame's z
    State state{};
    int material = 0;
    int generation = 0;  // 0: the primary
    int exponent = 0;    // of the branch's unit
    int changes = 0;     // of how it lies
    int moves = 0;       // those other than mirrors in that plane
    bool strayed = false;     // came otherwise than through matter from the ball's centre
    bool bent = false;        // at a surface, since it last forgot its direction

    void scale(int to) {
      if (to == exponent) return;
      const float ratio = power_of_two(to - exponent);
      exponent = to;
      scaled = scaled * ratio;
      height = height * Float4{ratio, ratio, ratio, 1};
      rise = rise * Float4{ratio, ratio, ratio, 1};
    }
    void lay() {
      rise = Float4{scaled.x[2], scaled.y[2], scaled.z[2], origin[2]};
      ++changes;
    }
    Float4 point(std::uint64_t word) const {
      const Float4 v = coordinates(word);
      return origin + scaled.x * v[0] + scaled.y * v[1] + scaled.z * v[2];
    }
    float height_of(std::uint64_t word) const {
      const Float4 v = coordinates(word) * height;
      return v[0] + v[1] + v[2] + height[3];
    }
    float rise_of(std::uint64_t word) const {
      const Float4 v = coordinates(word) * rise;
      return v[0] + v[1] + v[2] + rise[3];
    }
    float radius(std::uint64_t sphere) const {
      return static_cast<float>(sphere >> 48) * power_of_two(exponent);
    }
  };

  // What is known of the surface around a part of a branch. Heights are above the flat surroundings'
  // plane where that is all the surface there is; else along the frame's z.
  struct Near {
    bool flat = false;
    Band band;
  };

  // Where in a branch to begin other than at its start: where its energy falls to this.
  struct Middle {
    double energy;
    Vec3 position;       // in the specimen
  };

  void begin(const Vec3& direction, double energy_ev, const ReplayedPrimary& primary) {
    beam_ = direction;
    primary_ = primary;
    random_.begin(primary);
    hit_ = false;
    turned_ = false;
    generated_ = 0;
    left_ = 0;
    lost_ = 0;
    joined_ = 0;
    handed_over_here_ = 0;
    energy_in_ = energy_ev;
    energy_out_ = 0;
    generated_energy_ = 0;
    ++balance_.incident;
    balance_.incident_energy.add(energy_ev);
  }

  void end() {
    if (!hit_) ++balance_.missed;
    balance_.generated += generated_;
    balance_.absorbed += 1 + generated_ - left_ - lost_;
    balance_.generated_energy.add(generated_energy_);
    balance_.deposited_energy.add(energy_in_ + generated_energy_ - energy_out_);
  }

  double barrier_of(int material) const {
    return material < 0 ? 0.0 : media_[static_cast<std::size_t>(material)].barrier_ev;
  }

  // Through vacuum until it is inside; false when it is gone.
  bool fly(Free& e, int generation) {
    for (;;) {
      ++balance_.steps;
      if (hit_ && geometry_.flies_free(e.position, e.direction)) return escape(e, generation > 0);
      ++balance_.rays;
      const Crossing met = geometry_.crossing(e.position, e.direction,
                                              std::numeric_limits<double>::infinity(), e.state,
                                              surface_);
      if (met == Crossing::wrong_side) return lose(LossCause::wrong_side, e.energy);
      if (met == Crossing::none) return escape(e, generation > 0);
      hit_ = true;
      e.position = surface_.position;
      if (pass(e, surface_, generation)) return true;
    }
  }

  // At a surface: true if the electron is in matter afterwards.
  bool pass(Free& e, const typename Geometry::Surface& surface, int generation) {
    const double step = barrier_of(geometry_.material(e.state)) -
                        barrier_of(geometry_.material(surface.state_ahead));
    if (cross_barrier(barrier_, surface.normal, step, e.direction, e.energy, random_)) {
      e.state = surface.state_ahead;
      e.position = surface.position_ahead;
    }
    if (generation == 0) note_turn(e.direction);
    return geometry_.material(e.state) >= 0;
  }

  // A hair inside: where the first scattering is packed into the very point of entry, and that lies on
  // an edge, what starts there could leave unseen between two faces.
  void enter(const Free& e, const Vec3& normal) {
    const int material = geometry_.material(e.state);
    const CascadeLibrary* library = media_[static_cast<std::size_t>(material)].library;
    if (!library) return hand_over(e, 0);
    const std::uint64_t* root = library->cascade(primary_.cascade).data();
    cascade_begin_ = root;
    const Vec3 here = e.position + normal * (dot(normal, e.direction) > 0 ? inside_nm : -inside_nm);
    if (!patch_) frame_.origin = here;   // where floats are finest
    remember(NodeView(root));
    Branch branch;
    home_ = rotation_in(frame_, beam_frame(e.direction, primary_.azimuth));
    beam_in_ = float4(frame_.direction_in(beam_));
    branch.origin = float4(frame_.in(here));
    branch.scaled = home_;
    branch.state = e.state;
    branch.material = material;
    flat_point_ = float4(frame_.in(flat_.point));
    branch.strayed = squared_length(branch.origin - flat_point_) > here_nm * here_nm;
    branch.lay();
    follow(root, branch, {});
  }

  void note_turn(const Vec3& direction) {
    if (dot(direction, beam_) < 0) turned_ = true;
  }
  void note_turn(const Float4& way) {
    const Float4 along = way * beam_in_;
    if (along[0] + along[1] + along[2] < 0) turned_ = true;
  }

  // Whether a way meets no surface. What the patch knows of it stays in `crossed_`.
  bool is_clear(const Float4& from, const Float4& way) {
    if (patch_) {
      patch_->crossed(from, from + way, crossed_);
      if (crossed_.answer != Answer::unknown && crossed_.answer != Answer::crowded)
        return crossed_.answer == Answer::none;
    }
    const double clear = geometry_.clearance(frame_.out(vec3(from + way * 0.5f)));
    return 4 * clear * clear > static_cast<double>(squared_length(way));
  }

  void remember(const NodeView& view) {
    generated_ += view.node.generated;
    generated_energy_ += view.node.generated_ev;
  }
  void forget(const NodeView& view) {
    generated_ -= view.node.generated;
    generated_energy_ -= view.node.generated_ev;
  }
  double start_energy(const NodeView& view, int material) const {
    return media_[static_cast<std::size_t>(material)].code.decode(view.node.start.energy);
  }
  double start_total(const NodeView& child, int material) const {
    return start_energy(child, material) - barrier_of(material);
  }

  bool watching(const Branch& branch) const {
    return watch_turns_ && branch.generation == 0 && !turned_;
  }

  // Whether all of a sphere stays inside the material; else `near` is what is known around it.
  bool passed_over(Branch& branch, std::uint64_t sphere, Near& near) const {
    const float radius = branch.radius(sphere);
    if (near.flat) return std::fabs(branch.height_of(sphere)) > radius && !watching(branch);
    const float height = branch.rise_of(sphere);
    if (near.band.is_clear(height, radius)) return !watching(branch);
    const Float4 center = branch.point(sphere);
    if (lies_flat(branch, center, radius)) {
      near.flat = true;
      return std::fabs(branch.height_of(sphere)) > radius && !watching(branch);
    }
    near.band = {};
    if (patch_) {
      near.band = patch_->band(center, radius);
      if (near.band.is_clear(height, radius)) return !watching(branch);
      if (near.band.high - near.band.low < radius) return false;   // it is met
    }
    return geometry_.clearance(frame_.out(vec3(center))) > radius && !watching(branch);
  }

  // Whether a sphere lies in the flat surroundings. The branch then gets heights above their plane.
  bool lies_flat(Branch& branch, const Float4& center, float radius) const {
    if (branch.state != flat_.inside) return false;
    if (!flat_.whole || branch.strayed) {
      const double room = flat_.radius - radius;
      if (!(room > 0) || squared_length(center - flat_point_) > room * room) return false;
    }
    const auto along = [n = flat_normal_](const Float4& v) {
      return n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    };
    branch.height = Float4{along(branch.scaled.x), along(branch.scaled.y), along(branch.scaled.z),
                           along(branch.origin - flat_point_)};
    return true;
  }

  // Follows an electron through a node; false when it is gone. What it then does not generate is
  // taken off the account.
  bool follow(const std::uint64_t* at, Branch& branch, Near near, const Middle* middle = nullptr) {
    const NodeView view(at);
    branch.scale(view.node.exponent);
    if (view.node.level == 0) return follow_segments(view, branch, near, middle);
    int i = 0;
    if (middle) {
      i = child_at(view, *middle, branch.material);
      for (int k = i + 1; k < view.node.count; ++k) remember(NodeView(view.child(k)));
      if (!follow(view.child(i), branch, {}, middle)) return forget_from(view, i + 1);
      ++i;
    }
    for (; i < view.node.count; ++i) {
      Near of_child = near;
      if (passed_over(branch, view.spheres()[i], of_child)) continue;
      const int moves = branch.moves, changes = branch.changes;
      if (!follow(view.child(i), branch, of_child)) return forget_from(view, i + 1);
      if (branch.moves != moves) near = {};
      else if (branch.changes != changes) near.band = {};
    }
    return true;
  }

  bool forget_from(const NodeView& view, int child) {
    for (; child < view.node.count; ++child) forget(NodeView(view.child(child)));
    return false;
  }

  // The node below in which the energy falls to the middle's.
  int child_at(const NodeView& view, const Middle& middle, int material) const {
    int i = 0;
    while (i + 1 < view.node.count &&
           start_energy(NodeView(view.child(i + 1)), material) >= middle.energy)
      ++i;
    return i;
  }

  // The segment in which it does; `count` where rounding has it end before.
  int segment_at(const NodeView& view, const Middle& middle, int material) const {
    const EnergyCode& code = media_[static_cast<std::size_t>(material)].code;
    int i = 0;
    while (i < view.node.count && code.decode(read_vertex(view.vertex(i)).energy) >= middle.energy)
      ++i;
    return i;
  }

  bool follow_segments(const NodeView& view, Branch& branch, Near near, const Middle* middle) {
    const PackedNode& node = view.node;
    int i = 0, birth = 0;
    double energy = 0;   // 0: as packed
    std::uint64_t before = std::bit_cast<std::uint64_t>(node.start);
    if (middle) {
      i = segment_at(view, *middle, branch.material);
      birth = std::popcount(node.births & ((1u << i) - 1));
      remember_births(view, birth, branch.material);
      energy = middle->energy;
    }
    const auto height_of = [&](std::uint64_t word) {
      return near.flat ? branch.height_of(word) : branch.rise_of(word);
    };
    float low = height_of(before);
    for (; i < node.count; ++i) {
      const std::uint64_t vertex = *view.vertex(i);
      Moved moved = Moved::no;
      float high = height_of(vertex);
      const auto way_from = [&](const Float4& from) { return branch.point(vertex) - from; };
      if (near.flat) {
        if (watching(branch)) note_turn(way_from(branch.point(before)));
        if (high > 0) moved = cross_plane(view, i, before, low, high, branch);
      } else if (watching(branch) || middle || !near.band.is_beside(low, high)) {
        const Float4 from = middle ? float4(frame_.in(middle->position)) : branch.point(before);
        const Float4 way = way_from(from);
        if (watching(branch)) note_turn(way);
        if (!is_clear(from, way)) {
          if (energy == 0) energy = energy_before(view, i, branch.material);
          random_.at(event(view.vertex(i)));
          moved = cross_segment(from, way, energy, branch, true);
        }
      }
      if (moved == Moved::gone) return forget_births(view, birth, branch.material);
      if (moved == Moved::yes) near = {};
      if (moved != Moved::no && watching(branch)) note_turn(way_from(branch.point(before)));
      const bool goes_home = branch.bent && steady_ && EnergyCode::forgets(vertex);
      if (goes_home) {
        come_home(branch, vertex);
        if (!flat_.whole || branch.strayed) {   // what comes may leave the surroundings
          ++branch.moves;
          near = {};
        }
      }
      if (moved != Moved::no || goes_home) high = height_of(vertex);
      if (node.births & 1u << i) {
        follow_birth(view, birth, branch, vertex, near);
        ++birth;
      }
      middle = nullptr;
      energy = 0;
      before = vertex;
      low = high;
    }
    return true;
  }

  void follow_birth(const NodeView& view, int birth, Branch& parent, std::uint64_t vertex, Near near) {
    if (passed_over(parent, view.spheres()[birth], near)) return;
    Branch child = parent;
    child.origin = parent.point(vertex);
    child.height[3] = parent.height_of(vertex);
    child.rise[3] = child.origin[2];
    child.generation = parent.generation + 1;
    follow(view.child(birth), child, near);
  }

  void remember_births(const NodeView& view, int birth, int material) {
    for (; birth < view.children(); ++birth) {
      const NodeView child(view.child(birth));
      remember(child);
      generated_ += 1;
      generated_energy_ += start_total(child, material);
    }
  }

  bool forget_births(const NodeView& view, int birth, int material) {
    for (; birth < view.children(); ++birth) {
      const NodeView child(view.child(birth));
      forget(child);
      generated_ -= 1;
      generated_energy_ -= start_total(child, material);
    }
    return false;
  }

  double energy_before(const NodeView& view, int segment, int material) const {
    const std::uint16_t code = segment == 0 ? view.node.start.energy
                                            : read_vertex(view.vertex(segment - 1)).energy;
    return media_[static_cast<std::size_t>(material)].code.decode(code);
  }

  enum class Moved { no, mirrored, yes, gone };   // mirrored: in the flat surroundings' plane

  // What random numbers at this vertex go by.
  std::uint32_t event(const std::uint64_t* vertex) const {
    return static_cast<std::uint32_t>(vertex - cascade_begin_) +
           (static_cast<std::uint32_t>(joined_) << 16);
  }

  // A segment that leaves the flat surroundings' matter, from below the plane (`low`, a rounding
  // aside) to above it (`high`).
  Moved cross_plane(const NodeView& view, int segment, std::uint64_t before, float low, float high,
                    Branch& branch) {
    const std::uint64_t vertex = *view.vertex(segment);
    double energy = energy_before(view, segment, branch.material);
    const double rise = high - low;
    const Float4 units = coordinates(vertex) - coordinates(before);
    const double unit = power_of_two(branch.exponent);
    const double squared = squared_length(units) * unit * unit;
    // Total reflection with the energy at the segment's start is total reflection.
    if (energy * rise * rise <= flat_step_ev_ * squared) {
      reflect(branch);
      return Moved::mirrored;
    }
    random_.at(event(view.vertex(segment)));
    const double share = std::clamp(static_cast<double>(-low) / rise, 0.0, 1.0);
    const Float4 from = branch.point(before);
    const double whole = std::sqrt(squared);
    // Of unit length to the last bit, or `move` would mirror what goes on straight.
    const Vec3 direction = normalized(frame_.direction_out(vec3(branch.scaled(units))));
    const Packed& m = media_[static_cast<std::size_t>(branch.material)];
    Vec3 met_at = frame_.out(vec3(from)) + direction * (share * whole);
    met_at -= flat_.normal * dot(met_at - flat_.point, flat_.normal);
    surface_.distance = share * whole;
    surface_.position = surface_.position_ahead = met_at;
    surface_.normal = flat_.normal;
    surface_.state_ahead = flat_.outside;
    energy = m.medium->energy_after(energy, surface_.distance);
    Free e{met_at, direction, energy, branch.state};
    if (pass(e, surface_, branch.generation)) {
      if (e.state == branch.state) {
        reflect(branch);
        return Moved::mirrored;
      }
    } else if (!fly(e, branch.generation)) {
      return Moved::gone;
    }
    branch.strayed = true;
    if (geometry_.material(e.state) != branch.material) {
      join(e, branch.generation);
      return Moved::gone;
    }
    move(branch, direction, met_at, e);
    const double left = whole - share * whole;
    if (left > 0 && cross_segment(float4(frame_.in(e.position)),
                                  float4(frame_.direction_in(e.direction) * left), e.energy, branch, false) == Moved::gone)
      return Moved::gone;
    return Moved::yes;
  }

  void reflect(Branch& branch) const {
    const auto mirrored = [n = flat_normal_](const Float4& v) {
      return v - n * (2 * (n[0] * v[0] + n[1] * v[1] + n[2] * v[2]));
    };
    branch.scaled = {mirrored(branch.scaled.x), mirrored(branch.scaled.y),
                     mirrored(branch.scaled.z)};
    branch.origin = flat_point_ + mirrored(branch.origin - flat_point_);
    branch.height = -branch.height;
    branch.bent = true;
    branch.lay();
  }

  // Where an electron is scattered into all directions alike, the rest of its branch may lie as it
  // likes. It lies as in the cascade as it entered, so that a surface that is a little higher or lower
  // moves it a little, where a mirror would send it elsewhere.
  void come_home(Branch& branch, std::uint64_t vertex) const {
    const Float4 here = branch.point(vertex);
    const float height = branch.height_of(vertex);
    branch.scaled = home_ * power_of_two(branch.exponent);
    branch.origin += here - branch.point(vertex);
    const auto along = [n = flat_normal_](const Float4& v) {
      return n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    };
    branch.height = Float4{along(branch.scaled.x), along(branch.scaled.y), along(branch.scaled.z), 0};
    branch.height[3] = height - branch.height_of(vertex);
    branch.bent = false;
    branch.lay();
  }

  // The rest of the branch goes on from where the electron is, in its direction.
  void move(Branch& branch, const Vec3& direction, const Vec3& met_at, const Free& e) const {
    const Rotation motion = turn(frame_.direction_in(direction), frame_.direction_in(e.direction));
    branch.origin = float4(frame_.in(e.position)) + motion(branch.origin - float4(frame_.in(met_at)));
    branch.scaled = motion * branch.scaled;
    branch.state = e.state;
    ++branch.moves;
    branch.bent = true;
    branch.lay();
  }

  // The first surface on a way. Where triangles are many it is looked for bit by bit, each with few of
  // them. `asked`: is_clear was asked about just this way.
  Crossing crossing(const Vec3& from, const Vec3& direction, double left, State& state, bool asked) {
    if (patch_) {
      const Vec3 begin = frame_.in(from), along = frame_.direction_in(direction);
      double done = 0, bit = left;
      for (;; asked = false) {
        if (!asked)
          patch_->crossed(float4(begin + along * done), float4(begin + along * (done + bit)), crossed_);
        if (crossed_.answer == Answer::unknown) break;
        if (crossed_.answer == Answer::crowded) {
          if (bit < shortest_bit_nm) break;
          bit *= 0.5;
          continue;
        }
        if (crossed_.answer == Answer::some) {
          State ahead = state;
          const Crossing met =
              geometry_.crossing(from, direction, done + bit, ahead, surface_,
                                 std::span(crossed_.triangles).first(crossed_.count));
          if (met != Crossing::none) {
            state = ahead;
            return met;
          }
          if (ahead != state) break;   // between bodies of one material: all faces must be known
        }
        done += bit;
        if (done >= left) return Crossing::none;
        bit = std::min(2 * bit, left - done);
      }
    }
    if (!asked && geometry_.clearance(from + direction * (0.5 * left)) > 0.5 * left)
      return Crossing::none;
    ++balance_.rays;
    return geometry_.crossing(from, direction, left, state, surface_);
  }

  // A segment that may meet surfaces. What happens there moves the rest of the branch.
  Moved cross_segment(const Float4& start, const Float4& way, double energy, Branch& branch,
                      bool asked) {
    Vec3 from = frame_.out(vec3(start));
    Vec3 direction = frame_.direction_out(vec3(way));
    double left = length(direction);
    if (!(left > 0)) return Moved::no;
    direction *= 1.0 / left;
    const Packed& m = media_[static_cast<std::size_t>(branch.material)];
    Moved moved = Moved::no;
    for (int bounces = 0;; ++bounces) {
      const Crossing met = crossing(from, direction, left, branch.state, asked && bounces == 0);
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
        branch.strayed = true;
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

  // Goes on with a track of the material's library where its energy is the electron's, turned to its
  // direction: exact, as energy falls by continuous loss alone.
  void join(const Free& e, int generation) {
    const int material = geometry_.material(e.state);
    const Packed& m = media_[static_cast<std::size_t>(material)];
    if (!m.library) return hand_over(e, generation);
    if (e.energy <= m.medium->cutoff_ev()) return;
    if (++joined_ > most_joined) {
      lose(LossCause::too_many_steps, e.energy - m.barrier_ev);
      return;
    }
    const std::uint64_t* root =
        m.library->cascade(static_cast<std::size_t>(random_.uniform() *
                                                    static_cast<double>(m.library->cascades())))
            .data();
    const Middle middle{e.energy, e.position};
    NodeView leaf(root);
    while (leaf.node.level > 0) leaf = NodeView(leaf.child(child_at(leaf, middle, material)));
    const int segment = segment_at(leaf, middle, material);
    if (segment == leaf.node.count) return;   // as good as stopped
    const float unit = power_of_two(leaf.node.exponent);
    const std::uint64_t before = segment == 0 ? std::bit_cast<std::uint64_t>(leaf.node.start)
                                              : *leaf.vertex(segment - 1);
    const Vec3 a = vec3(coordinates(before) * unit);
    const Vec3 way = vec3(coordinates(*leaf.vertex(segment)) * unit) - a;
    const double whole = length(way);
    const Vec3 along = whole > 0 ? way * (1 / whole) : Vec3{0, 0, -1};
    const double done = m.medium->range_nm(energy_before(leaf, segment, material)) -
                        m.medium->range_nm(e.energy);
    const Vec3 begin = a + along * std::clamp(done, 0.0, whole);
    Branch branch;
    const Rotation before_joining = home_;
    home_ = rotation_in(frame_, beam_frame(e.direction, random_.uniform())) *
            turn(along, {0, 0, -1});
    branch.scaled = home_;
    branch.origin = float4(frame_.in(e.position)) - branch.scaled(float4(begin));
    branch.state = e.state;
    branch.material = material;
    branch.generation = generation;
    branch.strayed = true;
    branch.lay();
    const std::uint64_t* const cascade = cascade_begin_;
    cascade_begin_ = root;
    follow(root, branch, {}, &middle);
    cascade_begin_ = cascade;
    home_ = before_joining;
  }

  // A material without a library: direct simulation follows the electron and all that it generates.
  void hand_over(const Free& e, int generation) {
    ++left_;
    energy_out_ += e.energy - barrier_of(geometry_.material(e.state));
    ++balance_.handed_over;
    RandomStream random(primary_.seed, primary_.pixel,
                        primary_.electron + hand_over_stream * ++handed_over_here_);
    direct_.take_over({e.position, e.direction, e.energy, e.state, generation, -1, turned_}, beam_,
                      random);
  }

  bool escape(const Free& e, bool secondary) {
    ++left_;
    energy_out_ += e.energy;
    balance_.escaped_energy.add(e.energy);
    count_escape(balance_, e.energy, e.direction, hit_);
    if (hit_) detection_.escaped({e.energy, e.direction, secondary, turned_});
    return false;
  }

  bool lose(LossCause cause, double total_ev) {
    ++lost_;
    energy_out_ += total_ev;
    ++balance_.lost[static_cast<std::size_t>(cause)];
    balance_.lost_energy.add(total_ev);
    return false;
  }

  using Answer = SurfacePatch::Crossed::Answer;

  static constexpr double here_nm = 0.01;   // nearer than this, two places are one
  static constexpr double inside_nm = 1e-4;
  static constexpr double shortest_bit_nm = 0.1;
  static constexpr int most_bounces = 1000;
  static constexpr int most_joined = 2000;
  static constexpr std::uint64_t hand_over_stream = std::uint64_t{1} << 41;

  Geometry& geometry_;
  BarrierModel barrier_;
  bool watch_turns_;
  Direct& direct_;
  Detection& detection_;
  Balance& balance_;
  std::vector<Packed> media_;
  typename Geometry::Surface surface_;   // scratch
  FlatSurroundings<State> flat_;
  const SurfacePatch* patch_ = nullptr;
  SurfacePatch::Crossed crossed_;   // scratch
  Float4 flat_normal_{}, flat_point_{};
  double flat_step_ev_ = 0;
  bool steady_ = false;

  // Of the current primary:
  ReplayedPrimary primary_;
  ReplayRandom random_;
  Vec3 beam_;
  Float4 beam_in_{};   // in `frame_`
  Frame frame_;
  Rotation home_;   // how the cascade lay when it entered
  bool hit_ = false;
  bool turned_ = false;
  std::int64_t generated_ = 0, left_ = 0, lost_ = 0;
  int joined_ = 0;
  const std::uint64_t* cascade_begin_ = nullptr;
  std::uint64_t handed_over_here_ = 0;
  double energy_in_ = 0, energy_out_ = 0, generated_energy_ = 0;
};

}  // namespace surf::mc
