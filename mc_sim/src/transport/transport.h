// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The one transport loop. Geometry and observer are template parameters, so that the loop over a
// Scene without an observer costs nothing for either.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/geometry.h"
#include "physics/directions.h"
#include "surf/core/vec3.h"
#include "surf/mc/physics/barrier.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/transport/observer.h"
#include "surf/mc/transport/tally.h"
#include "transport/detection.h"
#include "transport/watcher.h"

namespace surf::mc {

struct Limits {
  static constexpr std::int64_t max_steps = 100'000'000;  ///< of one primary with its secondaries
  static constexpr std::size_t max_waiting = 1'000'000;   ///< tracks not yet followed
};

/// Adds an electron that has left for good to the balance (without its energy). `hit`: whether its
/// primary met the specimen.
inline TrackKind count_escape(Balance& balance, double energy_ev, const Vec3& direction, bool hit) {
  if (hit && energy_ev < se_bse_split_ev) {
    ++balance.se;
    return TrackKind::se;
  }
  if (hit && direction.z >= 0) {
    ++balance.bse;
    return TrackKind::bse;
  }
  ++balance.transmitted;
  return TrackKind::transmitted;
}

template <Geometry G, Watcher W>
class Transport {
 public:
  using State = typename G::State;

  /// `drop_unreachable`: whether electrons that cannot come near a surface any more are absorbed at
  /// once. It changes no detector's mean or variance, but observers miss the rest of those tracks.
  Transport(G& geometry, const std::vector<const Medium*>& media, BarrierModel barrier,
            bool drop_unreachable, W& watcher, Detection& detection, Balance& balance)
      : geometry_(geometry), media_(media), barrier_(barrier), drop_unreachable_(drop_unreachable),
        watcher_(watcher), detection_(detection), balance_(balance) {}

  /// Follows a primary and all its secondaries; true if the primary met the specimen. `energy_ev`
  /// counts as `state`'s material says.
  bool run(const Vec3& start, const Vec3& direction, double energy_ev, State state,
           RandomStream& random) {
    ++balance_.incident;
    balance_.incident_energy.add(energy_ev - barrier_of(geometry_.material(state)));
    hit_ = geometry_.material(state) >= 0;
    follow_all({start, direction, energy_ev, state, 0, -1, false}, direction, random);
    if (!hit_) ++balance_.missed;
    return hit_;
  }

  struct Track {
    Vec3 position;
    Vec3 direction;
    double energy;
    State state;
    int generation;
    int parent;
    bool turned;  // the primary had, by more than 90 degrees, when this cascade began
  };

  /// Follows an electron inside the specimen that another method gives up, with all that it
  /// generates. `beam` is its primary's direction at the start.
  void take_over(const Track& track, const Vec3& beam, RandomStream& random) {
    hit_ = true;
    follow_all(track, beam, random);
  }

 private:
  void follow_all(Track track, const Vec3& beam, RandomStream& random) {
    beam_ = beam;
    steps_ = 0;
    tracks_ = 0;
    waiting_.clear();
    follow(track, random);
    while (!waiting_.empty()) {
      track = waiting_.back();
      waiting_.pop_back();
      follow(track, random);
    }
    balance_.steps += steps_;
  }

  double barrier_of(int material) const {
    return material < 0 ? 0.0 : media_[static_cast<std::size_t>(material)]->barrier_ev();
  }

  void follow(Track& t, RandomStream& random) {
    number_ = tracks_++;
    deposited_ = 0;
    watcher_.begin_track(number_, t.parent, t.generation, t.position, t.direction, t.energy);
    for (;;) {
      const int material = geometry_.material(t.state);
      const bool goes_on = material < 0 ? fly(t, random) : travel(t, material, random);
      if (!goes_on) break;
    }
    balance_.deposited_energy.add(deposited_);
  }

  // Straight on through vacuum to the next surface. False when the electron is gone.
  bool fly(Track& t, RandomStream& random) {
    ++steps_;
    if (geometry_.flies_free(t.position, t.direction)) return escape(t);
    ++balance_.rays;
    typename G::Surface& surface = surface_;
    const Crossing met = geometry_.crossing(
        t.position, t.direction, std::numeric_limits<double>::infinity(), t.state, surface);
    if (met == Crossing::wrong_side) return lose(t, LossCause::wrong_side);
    if (met == Crossing::none) return escape(t);
    hit_ = true;
    watcher_.segment(t.position, surface.position, t.energy, t.energy, -1);
    t.position = surface.position;
    enter(t, surface, random);
    return true;
  }

  // Scatters inside a material until it leaves it or stops. False when the electron is gone.
  bool travel(Track& t, int material, RandomStream& random) {
    const Medium& medium = *media_[static_cast<std::size_t>(material)];
    if (t.energy <= medium.cutoff_ev()) return absorb(t, medium);
    // Within this distance there is nothing but this material: where no surface can be reached,
    // there is no ray, and where none can be reached ever again, a cascade is not followed.
    double clear = geometry_.clearance(t.position);
    // Where losses come in events, reaches are long and steps many: what is left of a clearance is
    // as good as a new one.
    const bool in_events = medium.loses_in_events();
    for (;;) {
      if (++steps_ > Limits::max_steps) return lose(t, LossCause::too_many_steps);
      if (drop_unreachable_ && medium.range_nm(t.energy) < clear) return drop(t, medium);
      const Medium::Step step = medium.step(t.energy, -std::log(random.uniform()));
      if (in_events && step.length_nm > clear) clear = geometry_.clearance(t.position);
      if (step.length_nm > clear) {
        ++balance_.rays;
        typename G::Surface& surface = surface_;
        const Crossing met =
            geometry_.crossing(t.position, t.direction, step.length_nm, t.state, surface);
        if (met == Crossing::surface) {
          const double energy = medium.energy_after(t.energy, surface.distance);
          advance(t, surface.position, energy, material);
          enter(t, surface, random);
          return true;
        }
        if (met == Crossing::wrong_side) return lose(t, LossCause::wrong_side);
        if (!(step.length_nm < geometry_.farthest())) return lose(t, LossCause::no_surface_ahead);
      }
      advance(t, t.position + t.direction * step.length_nm, step.energy_ev, material);
      if (step.stopped) return absorb(t, medium);
      clear = in_events ? clear - step.length_nm : geometry_.clearance(t.position);
      if (!scatter(t, medium, clear, random)) return false;
      if (t.energy <= medium.cutoff_ev()) return absorb(t, medium);
    }
  }

  void advance(Track& t, const Vec3& to, double energy, int material) {
    watcher_.segment(t.position, to, t.energy, energy, material);
    watcher_.deposit(t.position, to, t.energy - energy);
    deposited_ += t.energy - energy;
    t.position = to;
    t.energy = energy;
  }

  void enter(Track& t, const typename G::Surface& surface, RandomStream& random) {
    const double step = barrier_of(geometry_.material(t.state)) -
                        barrier_of(geometry_.material(surface.state_ahead));
    if (cross_barrier(barrier_, surface.normal, step, t.direction, t.energy, random)) {
      t.state = surface.state_ahead;
      t.position = surface.position_ahead;
    }
    note_turn(t);
  }

  void note_turn(Track& t) const {
    if (t.generation == 0 && dot(t.direction, beam_) < 0) t.turned = true;
  }

  bool scatter(Track& t, const Medium& medium, double clear, RandomStream& random) {
    ScatterEvent event;
    const Scattering& mechanism = medium.choose(t.energy, random.uniform());
    mechanism.scatter(t.energy, random, event);
    deposited_ += event.energy_loss_ev;
    if (event.energy_loss_ev != 0) watcher_.deposit(t.position, t.position, event.energy_loss_ev);
    if (event.has_secondary && !add_secondary(t, medium, clear, event.secondary_energy_ev,
                                              event.secondary_direction, event.energy_loss_ev > 0))
      return lose(t, LossCause::too_many_secondaries);
    if (event.auger_energy_ev > 0) {
      watcher_.segment(t.position, t.position, t.energy, t.energy,
                       geometry_.material(t.state));  // a point for each birth
      if (!add_secondary(t, medium, clear, event.auger_energy_ev, event.auger_direction, true))
        return lose(t, LossCause::too_many_secondaries);
    }
    t.energy -= event.energy_loss_ev;
    watcher_.scattered(event.isotropic, t.energy);
    if (event.isotropic) t.direction = from_axis(event.cos_theta, event.turn);
    else if (event.cos_theta != 1.0)
      t.direction = deflected(t.direction, event.cos_theta, event.turn);
    note_turn(t);
    return true;
  }

  // False when too many are waiting. `paid`: the energy is part of what an electron has lost.
  bool add_secondary(const Track& t, const Medium& medium, double clear, double energy,
                     const Vec3& direction, bool paid) {
    if (energy <= medium.cutoff_ev()) return true;  // it never was an electron that moves
    const double total = energy - medium.barrier_ev();
    ++balance_.generated;
    if (paid) deposited_ -= total;
    else balance_.generated_energy.add(total);
    if (drop_unreachable_ && medium.range_nm(energy) < clear) {
      ++balance_.absorbed;
      ++balance_.dropped;
      balance_.deposited_energy.add(total);
      return true;
    }
    watcher_.deposit(t.position, t.position, -total);
    if (waiting_.size() >= Limits::max_waiting) {
      ++balance_.lost[static_cast<std::size_t>(LossCause::too_many_secondaries)];
      balance_.lost_energy.add(total);
      return false;
    }
    waiting_.push_back({t.position, from_frame_of(t.direction, direction), energy, t.state,
                        t.generation + 1, number_, t.turned});
    return true;
  }

  bool escape(const Track& t) {
    balance_.escaped_energy.add(t.energy);
    const TrackKind end = count_escape(balance_, t.energy, t.direction, hit_);
    if (hit_) detection_.escaped({t.energy, t.direction, t.generation > 0, t.turned});
    watcher_.end_track(end, t.position, t.direction, t.energy);
    return false;
  }

  bool drop(const Track& t, const Medium& medium) {
    ++balance_.dropped;
    return absorb(t, medium);
  }

  bool absorb(const Track& t, const Medium& medium) {
    ++balance_.absorbed;
    deposited_ += t.energy - medium.barrier_ev();
    watcher_.deposit(t.position, t.position, t.energy - medium.barrier_ev());
    watcher_.end_track(TrackKind::absorbed, t.position, t.direction, t.energy);
    return false;
  }

  bool lose(const Track& t, LossCause cause) {
    ++balance_.lost[static_cast<std::size_t>(cause)];
    balance_.lost_energy.add(t.energy - barrier_of(geometry_.material(t.state)));
    watcher_.end_track(TrackKind::lost, t.position, t.direction, t.energy);
    return false;
  }

  G& geometry_;
  const std::vector<const Medium*>& media_;
  BarrierModel barrier_;
  bool drop_unreachable_;
  W& watcher_;
  Detection& detection_;
  Balance& balance_;
  Vec3 beam_;  // the primary's direction at its start
  bool hit_ = false;
  std::vector<Track> waiting_;
  typename G::Surface surface_;  // scratch
  double deposited_ = 0;         // by the current track
  std::int64_t steps_ = 0;
  int tracks_ = 0;
  int number_ = 0;
};

}  // namespace surf::mc
