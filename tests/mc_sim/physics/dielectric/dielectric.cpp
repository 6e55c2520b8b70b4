// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/kept_tables.h"
#include "physics/directions.h"
#include "physics/mechanism_test.h"
#include "transport/detection.h"
#include "transport/endless.h"

namespace surf::mc {
namespace {

using atomic::hartree_ev;

Physics tier(const char* more = "") {
  Physics p;
  parse_physics(std::string("inelastic=dielectric,") + more, p);
  return p;
}

// Every event pays for its secondary, out of a filled state into a free one.
TEST(Dielectric, MovesElectronsFromFilledToFreeStates) {
  for (const char* name : {"Al", "Si", "SiO2", "Au"}) {
    const DielectricData& d = *material(name).dielectric;
    const auto losses = make_dielectric(material(name), tier());
    RandomStream random(4, 0, 0);
    for (const double above : {20.0, 200.0, 3000.0}) {
      const double energy = d.barrier_ev() + above;
      int freed = 0;
      for (int i = 0; i < 3000; ++i) {
        ScatterEvent e;
        losses->scatter(energy, random, e);
        if (!e.has_secondary) continue;
        ++freed;
        EXPECT_GE(energy - e.energy_loss_ev, d.band.free_ev() - 1e-9) << name;
        EXPECT_GE(e.secondary_energy_ev, d.band.free_ev() - 1e-9) << name;
        EXPECT_LE(e.secondary_energy_ev, d.band.filled_ev + e.energy_loss_ev + 1e-9) << name;
        EXPECT_NEAR(length(e.secondary_direction), 1, 1e-8);
        EXPECT_EQ(e.auger_energy_ev, 0);
        EXPECT_FALSE(e.isotropic);
      }
      EXPECT_GT(freed, 2900) << name;
    }
  }
}

// Where a single electron takes loss and momentum, the three momenta of before are those of after:
// what the secondary had lies inside the filled band, in its size and in its energy.
TEST(Dielectric, ConservesMomentumInBinaryCollisions) {
  const DielectricData& d = *material("Al").dielectric;
  const auto losses = make_dielectric(material("Al"), tier());
  RandomStream random(5, 0, 0);
  const double energy = 2000;
  int binary = 0, all = 0;
  for (int i = 0; i < 20000; ++i) {
    ScatterEvent e;
    losses->scatter(energy, random, e);
    if (!e.has_secondary || e.energy_loss_ev < 100)
      continue;  // far beyond the plasmon: pairs, or the L shell
    const double before = atomic::momentum(energy / hartree_ev),
                 after = atomic::momentum((energy - e.energy_loss_ev) / hartree_ev);
    const Vec3 given = Vec3{0, 0, before} - from_axis(e.cos_theta, e.turn) * after;
    const Vec3 had =
        e.secondary_direction * std::sqrt(2 * e.secondary_energy_ev / hartree_ev) - given;
    const double had_ev = 0.5 * dot(had, had) * hartree_ev;
    ++all;
    if (std::fabs(had_ev - (e.secondary_energy_ev - e.energy_loss_ev)) > 1e-6 * energy) continue;
    ++binary;
    EXPECT_LE(had_ev, d.band.filled_ev * (1 + 1e-9));
  }
  EXPECT_GT(binary, 0.1 * all);
  EXPECT_GT(all, 100);
}

TEST(Dielectric, FreesAugerElectronsOnDemand) {
  const DielectricData& d = *material("Si").dielectric;
  const auto losses = make_dielectric(material("Si"), tier("auger=on"));
  RandomStream random(6, 0, 0);
  int auger = 0, of_the_k_shell = 0;
  for (int i = 0; i < 200000; ++i) {
    ScatterEvent e;
    losses->scatter(8000, random, e);
    if (!(e.auger_energy_ev > 0)) continue;
    ++auger;
    // From the L shell by two valence electrons, 92 eV measured; from the K shell by two of the L
    // shell, 1616 eV measured.
    const bool k_shell = e.auger_energy_ev > 200;
    EXPECT_NEAR(e.auger_energy_ev - d.barrier_ev(), k_shell ? 1616 : 92, k_shell ? 25 : 14);
    of_the_k_shell += k_shell;
    EXPECT_LE(e.auger_energy_ev + e.secondary_energy_ev,
              e.energy_loss_ev + 3 * d.band.filled_ev + 1e-9);
  }
  EXPECT_GT(auger, 1000);
  EXPECT_GT(of_the_k_shell, 100);
}

TEST(Dielectric, MakesNoSecondariesWhereTheyAreOff) {
  const auto losses = make_dielectric(material("Si"), tier("secondaries=off"));
  RandomStream random(7, 0, 0);
  ScatterEvent e;
  losses->scatter(1000, random, e);
  EXPECT_FALSE(e.has_secondary);
  EXPECT_GT(e.energy_loss_ev, 0);
}

TEST(Dielectric, SharesItsTablesBetweenMedia) {
  const auto losses = kept_losses(material("Si"), tier());
  EXPECT_EQ(kept_losses(material("Si"), tier("auger=on")), losses);
  EXPECT_NE(kept_losses(material("Si"), tier("inelastic-model=single-pole")), losses);
  EXPECT_NE(kept_losses(material("Al"), tier()), losses);
  const Medium medium = make_medium(material("Si"), tier());
  EXPECT_TRUE(medium.loses_in_events());
  EXPECT_FALSE(medium.loses_continuously());
}

/// How far any electron of a cascade gets.
struct Farthest {
  double nm = 0;
  void begin_track(int, int, int, const Vec3&, const Vec3&, double) {}
  void segment(const Vec3&, const Vec3& to, double, double, int) { nm = std::max(nm, length(to)); }
  void deposit(const Vec3&, const Vec3&, double) {}
  void scattered(bool, double) {}
  void end_track(TrackKind, const Vec3&, const Vec3&, double) {}
};

// Less than one in a million gets farther than the bound, so none of 20,000; but some come near it.
TEST(Dielectric, BoundsTheReachOfElectrons) {
  const Medium medium = make_medium(material("Si"), tier());
  const std::vector<const Medium*> media{&medium};
  for (const double above : {3.0, 60.0, 700.0}) {
    const double energy = medium.barrier_ev() + above;
    Endless endless;
    Farthest farthest;
    Detection detection(default_detectors(), {}, false);
    Balance balance;
    Transport<Endless, Farthest> transport(endless, media, BarrierModel::quantum, false, farthest,
                                           detection, balance);
    for (std::uint64_t i = 0; i < (above > 500 ? 3000u : 20000u); ++i) {
      RandomStream random(9, 0, i);
      transport.run({}, {0, 0, -1}, energy, 0, random);
    }
    EXPECT_LT(farthest.nm, medium.range_nm(energy)) << above;
    EXPECT_GT(farthest.nm, 0.4 * medium.range_nm(energy)) << above;
  }
  double last = 0;
  for (double energy = medium.barrier_ev() + 0.5; energy < 2e4; energy *= 1.1) {
    EXPECT_GE(medium.range_nm(energy), last);
    last = medium.range_nm(energy);
  }
}

}  // namespace
}  // namespace surf::mc
