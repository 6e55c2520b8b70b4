// SPDX-License-Identifier: GPL-3.0-or-later
// What both samplers draw, against the doubly differential cross-section that they are tables of.
#include "physics/dielectric/loss_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/pole_line.h"
#include "statistics.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/physics/full_penn.h"
#include "surf/mc/physics/single_pole.h"

namespace surf::mc {
namespace {

using atomic::hartree_ev;

const DielectricData& data_of(const char* name) {
  return *io::find_material(name, "test").dielectric;
}

// Cells in the loss and the momentum, both as parts of what is possible.
struct Cells {
  static constexpr int losses = 12, momenta = 6;
  double least, most;  // of losses, hartree
  double energy;

  int of(double w, double q) const {
    const double p = atomic::momentum(energy), after = atomic::momentum(energy - w);
    const int i = static_cast<int>(losses * std::log(w / least) / std::log(most / least));
    const int j =
        static_cast<int>(momenta * std::log(q / (p - after)) / std::log((p + after) / (p - after)));
    return std::clamp(i, 0, losses - 1) * momenta + std::clamp(j, 0, momenta - 1);
  }
};

void expect_drawn(const LossSampler& sampler, const DielectricData& d, double energy_ev,
                  const std::vector<double>& density, const Cells& cells) {
  constexpr int draws = 10000;  // tables are true to some percent in a cell: more would show it
  std::vector<std::int64_t> counts(density.size());
  RandomStream random(11, 3, static_cast<std::uint64_t>(energy_ev));
  for (int i = 0; i < draws; ++i) {
    Loss loss;
    ASSERT_TRUE(sampler.draw(energy_ev, random, loss));
    ASSERT_GE(energy_ev - loss.energy * hartree_ev, d.band.free_ev() * (1 - 1e-12));
    ++counts[static_cast<std::size_t>(cells.of(loss.energy, loss.momentum))];
  }
  double whole = 0;
  for (const double p : density) whole += p;
  std::vector<double> expected;
  for (const double p : density) expected.push_back(draws * p / whole);
  test::expect_distributed(counts, expected, 20);
}

Cells cells_for(const DielectricData& d, double energy_ev) {
  return {std::max(d.band.gap_ev, 0.5) / hartree_ev, (energy_ev - d.band.free_ev()) / hartree_ev,
          energy_ev / hartree_ev};
}

struct Case {
  const char* material;
  double above_ev;  // the vacuum level
};

TEST(SinglePoleSampler, DrawsLossesAndMomentaTogether) {
  for (const auto& [name, above] : std::initializer_list<Case>{{"Al", 9},
                                                               {"Al", 300},
                                                               {"Si", 23},
                                                               {"Si", 71},
                                                               {"Si", 1000},
                                                               {"SiO2", 40},
                                                               {"SiO2", 7300}}) {
    const DielectricData& d = data_of(name);
    const auto sampler = make_single_pole_sampler(d);
    const SinglePole pole(d.elf, d.band);
    const double energy_ev = above + d.barrier_ev(), energy = energy_ev / hartree_ev;
    SCOPED_TRACE(std::string(name) + ", " + std::to_string(above) + " eV above the vacuum level");
    const Cells cells = cells_for(d, energy_ev);
    std::vector<double> density(Cells::losses * Cells::momenta);
    constexpr int n = 6000, steps = 120;
    const double from = std::log(std::max(d.band.gap_ev, 0.02)),
                 h = (std::log(energy_ev - d.band.free_ev()) - from) / n;
    for (int i = 0; i < n; ++i) {
      const double w0_ev = std::exp(from + (i + 0.5) * h), w0 = w0_ev / hartree_ev,
                   value = pole.elf()(w0_ev);
      const SinglePole::Momenta m = pole.momenta(energy, w0);
      if (!(value > 0 && m.last > m.first)) continue;
      const double step = std::log(m.last / m.first) / steps;
      for (int k = 0; k < steps; ++k) {
        const double q = m.first * std::exp((k + 0.5) * step), w = PoleLine(w0).loss(q);
        density[static_cast<std::size_t>(cells.of(w, q))] += value * w0 * w0 * step / w;
      }
    }
    expect_drawn(*sampler, d, energy_ev, density, cells);
  }
}

TEST(FullPennSampler, DrawsLossesAndMomentaTogether) {
  for (const auto& [name, above] : std::initializer_list<Case>{
           {"Al", 9}, {"Al", 300}, {"Si", 23}, {"Si", 1000}, {"SiO2", 71}}) {
    const DielectricData& d = data_of(name);
    const auto sampler = make_full_penn_sampler(d);
    const FullPenn penn(d);
    const double energy_ev = above + d.barrier_ev(), energy = energy_ev / hartree_ev;
    SCOPED_TRACE(std::string(name) + ", " + std::to_string(above) + " eV above the vacuum level");
    const Cells cells = cells_for(d, energy_ev);
    std::vector<double> density(Cells::losses * Cells::momenta);
    constexpr int n = 1600, steps = 160;
    const double from = std::log(std::max(d.band.gap_ev, 0.02)),
                 h = (std::log(energy_ev - d.band.free_ev()) - from) / n;
    for (int i = 0; i < n; ++i) {
      const double w = std::exp(from + (i + 0.5) * h) / hartree_ev;
      const double p = atomic::momentum(energy), after = atomic::momentum(energy - w);
      const double step = std::log((p + after) / (p - after)) / steps;
      for (int k = 0; k < steps; ++k) {
        const double q = (p - after) * std::exp((k + 0.5) * step);
        const FullPenn::Parts parts = penn.value(w, q);
        density[static_cast<std::size_t>(cells.of(w, q))] +=
            (parts.plasmon + parts.pairs) * w * step;
      }
    }
    expect_drawn(*sampler, d, energy_ev, density, cells);
  }
}

TEST(LossSampler, TakesAFewMegabytesAMaterial) {
  for (const char* name : {"Si", "Au"}) {
    EXPECT_LT(make_single_pole_sampler(data_of(name))->bytes(), 4u << 20);
    EXPECT_LT(make_full_penn_sampler(data_of(name))->bytes(), 8u << 20);
  }
}

TEST(LossSampler, DrawsNothingWhereNothingCanBeLost) {
  const DielectricData& d = data_of("SiO2");
  RandomStream random(1, 2, 3);
  Loss loss;
  for (const auto& sampler : {make_single_pole_sampler(d), make_full_penn_sampler(d)}) {
    EXPECT_FALSE(sampler->draw(d.band.free_ev() + 8.9, random, loss));
    EXPECT_EQ(sampler->inverse_mean_free_path_per_nm(d.band.free_ev() + 8.0), 0);
  }
}

}  // namespace
}  // namespace surf::mc
