// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/full_penn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "csv.h"
#include "surf/io/sim/materials.h"

namespace surf::mc {
namespace {

constexpr double hartree_ev = 27.211386246, bohr_nm = 0.0529177210903;

const DielectricData& data_of(const std::string& name) {
  return *io::find_material(name, "test").dielectric;
}

const FullPenn& penn_of(const std::string& name) {
  static std::map<std::string, FullPenn> kept;
  return kept.try_emplace(name, data_of(name)).first->second;
}

// Tanuma, Powell and Penn (2011); energies count from the Fermi level.
TEST(FullPenn, HasThePublishedFreePaths) {
  for (const auto& row : test::read_reference("imfp_full_penn.csv")) {
    const double energy_ev = std::stod(row.at("energy_ev"));
    for (const char* name : {"Au", "Cu", "Si", "Ni", "Ge", "Ag", "W"}) {
      const double path =
          1 / penn_of(name).inverse_mean_free_path_per_nm(energy_ev + data_of(name).band.filled_ev);
      EXPECT_NEAR(path / std::stod(row.at(name)), 1, energy_ev < 99 ? 0.15 : 0.08)
          << name << ", " << energy_ev << " eV";
    }
  }
}

TEST(FullPenn, LosesAsMuchAsTheLossFormulaAtHighEnergies) {
  for (const auto& row : test::read_reference("stopping_joyluo.csv")) {
    const std::string name = row.at("element");
    if (name != "Al" && name != "Si" && name != "Cu" && name != "Ag" && name != "Au" &&
        name != "Ni" && name != "Ge")
      continue;
    for (const int energy_ev : {2000, 5000, 10000}) {
      const double formula = std::stod(row.at("S_" + std::to_string(energy_ev) + "eV_eV_per_nm"));
      const double loss =
          penn_of(name).stopping_power_ev_per_nm(energy_ev + data_of(name).band.filled_ev);
      EXPECT_NEAR(loss / formula, 1, 0.15) << name << ", " << energy_ev;
    }
  }
}

TEST(FullPenn, HasTheFreePathOfOtherProgramsInSilicon) {
  EXPECT_NEAR(1 / penn_of("Si").inverse_mean_free_path_per_nm(1000 + data_of("Si").barrier_ev()),
              2.55, 0.05 * 2.55);
}

// All gases fulfil the f-sum at all momenta, so the function does: what it loses in one place it
// gains in another.
TEST(FullPenn, KeepsTheSumRuleAtEveryMomentum) {
  const DielectricData& al = data_of("Al");
  const double to_ev = 2.5e4;
  const auto sum = [&](double q) {
    double s = 0;
    constexpr int n = 4000;
    const double from = std::log(0.05 / hartree_ev), h = (std::log(to_ev / hartree_ev) - from) / n;
    for (int i = 0; i < n; ++i) {
      const double w = std::exp(from + (i + 0.5) * h);
      const FullPenn::Parts p = penn_of("Al").value(w, q);
      s += h * w * w * (p.plasmon + p.pairs);
    }
    return s;
  };
  double optical = 0;
  for (double w = 0.05, h = 1e-3; w < to_ev; w *= 1 + h)
    optical += h * w * w * al.elf(w) / (hartree_ev * hartree_ev);
  for (const double q : {0.1, 0.4, 0.8, 1.5, 4.0}) EXPECT_NEAR(sum(q) / optical, 1, 0.03) << q;
}

// Lindhard's function at a complex loss, as it is written down with principal logarithms.
std::complex<double> lindhard(double k, double q, std::complex<double> w) {
  const double z = 0.5 * q / k;
  const std::complex<double> u = w / (q * k);
  const auto part = [](std::complex<double> d) {
    return (1.0 - d * d) * std::log((d + 1.0) / (d - 1.0));
  };
  return 1.0 + 1 / (M_PI * k * z * z) * (0.5 + (part(z - u) + part(z + u)) / (8 * z));
}

// Another way to the same integral: plasmons are no lines but lie a little off the real axis, and
// nothing is asked of where continua begin.
double brute_force_per_nm(const DielectricData& d, double energy_ev) {
  const EnergyLossFunction elf = d.band.gap_ev > 0 ? d.elf.above(d.band.gap_ev) : d.elf;
  const double energy = energy_ev / hartree_ev,
               most = (energy_ev - d.band.filled_ev - d.band.gap_ev) / hartree_ev;
  const double least = std::max(d.band.gap_ev, 0.1) / hartree_ev, damping = 0.01;
  constexpr int losses = 70, momenta = 50;
  const double hw = std::log(most / least) / losses, step = 0.004;
  double sum = 0;
  for (int i = 0; i < losses; ++i) {
    const double w = least * std::exp((i + 0.5) * hw);
    const double p = std::sqrt(2 * energy), after = std::sqrt(2 * (energy - w));
    const double hq = std::log((p + after) / (p - after)) / momenta;
    for (int j = 0; j < momenta; ++j) {
      const double q = (p - after) * std::exp((j + 0.5) * hq);
      double value = 0;
      for (double wp = 0.05 / hartree_ev; wp < 2000 / hartree_ev; wp *= std::exp(step)) {
        const double g = 2 / M_PI * elf(wp * hartree_ev);  // times wp, over wp
        if (g > 0)
          value +=
              g * step *
              std::imag(-1.0 / lindhard(std::cbrt(0.75 * M_PI * wp * wp), q, {w, damping * w}));
      }
      sum += value * hq * hw * w;
    }
  }
  return sum / (M_PI * energy) / bohr_nm;
}

TEST(FullPenn, AgreesWithABruteForceIntegral) {
  for (const auto& [name, above_ev] :
       {std::pair{"Si", 30.0}, {"Si", 200.0}, {"Cu", 60.0}, {"Au", 150.0}}) {
    const double energy_ev = above_ev + data_of(name).band.filled_ev;
    EXPECT_NEAR(penn_of(name).inverse_mean_free_path_per_nm(energy_ev) /
                    brute_force_per_nm(data_of(name), energy_ev),
                1, 0.02)
        << name << ", " << above_ev;
  }
}

// Slow electrons lose to pairs, which a single pole does not have: the free path is a fraction of
// that.
TEST(FullPenn, LetsSlowElectronsLose) {
  EXPECT_NEAR(1 / penn_of("Si").inverse_mean_free_path_per_nm(20), 1.75, 0.2);
  EXPECT_EQ(penn_of("Si").inverse_mean_free_path_per_nm(7.27 + 2 * 1.12 - 0.01), 0);
  EXPECT_EQ(penn_of("SiO2").inverse_mean_free_path_per_nm(20 + 17.9), 0);
}

}  // namespace
}  // namespace surf::mc
