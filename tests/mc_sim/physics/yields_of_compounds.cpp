// SPDX-License-Identifier: GPL-3.0-or-later
// Yields of compounds between those of their elements, and of a film between film and substrate.
#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/mechanism_test.h"
#include "specimens.h"
#include "surf/mc/physics/element.h"
#include "surf/mc/physics/material_draft.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {
namespace {

// An element as it occurs in the compound: of unit density, with the compound's barrier.
Material bare_element(int atomic_number, const Material& compound) {
  MaterialDraft draft;
  draft.name = element(atomic_number).symbol;
  draft.formula = {{atomic_number, 1}};
  draft.density_g_cm3 = 1;
  draft.work_function_ev = compound.work_function_ev;
  draft.barrier_ev = compound.barrier_ev;
  draft.loss_join_ev = compound.loss_join_ev;
  return complete(draft);
}

test::Yields flat_yields(const Material& material, double energy_ev, std::int64_t electrons,
                         const Physics& physics = {}) {
  Specimen specimen;
  specimen.materials = {material};
  specimen.substrate = Substrate{};
  Beam beam;
  beam.energy_ev = energy_ev;
  return test::yields(
      test::simulate(specimen, beam, test::square_scan(10, 4), electrons / 16, physics));
}

// eta rises with Z between the lightest and the heaviest element. Heinrich's rule, means by weight,
// is empirical and holds to some 5 % of the higher eta.
TEST(CompoundYield, BseLieBetweenThoseOfTheElementsAndNearHeinrichsRule) {
  int comparisons = 0;
  for (const char* name : {"SiO2", "TiO2", "PMMA"}) {
    const Material& compound = material(name);
    for (const double energy : {3000.0, 10000.0}) {
      double low = 1, high = 0, by_weight = 0, worst = 0;
      for (const Constituent& c : compound.constituents) {
        if (c.atomic_number == 1) continue;  // practically no BSE, and 8 % of the mass of PMMA
        const auto y = flat_yields(bare_element(c.atomic_number, compound), energy, 16000);
        low = std::min(low, y.bse.mean);
        high = std::max(high, y.bse.mean);
        by_weight += c.weight_fraction * y.bse.mean;
        worst = std::max(worst, y.bse.standard_error);
      }
      const auto y = flat_yields(compound, energy, 16000);
      const double noise = test::z_limit(18) * std::hypot(worst, y.bse.standard_error);
      if (std::string(name) != "PMMA") {
        EXPECT_GT(y.bse.mean, low - noise) << name << " at " << energy;
      }
      EXPECT_LT(y.bse.mean, high + noise) << name << " at " << energy;
      EXPECT_NEAR(y.bse.mean, by_weight, 0.06 * high + noise) << name << " at " << energy;
      ++comparisons;
    }
  }
  EXPECT_EQ(comparisons, 6);
}

// A large slab of gold on silicon.
test::Yields film(double thickness_nm, double energy_ev, std::int64_t electrons) {
  Specimen specimen;
  specimen.materials = {material("Si"), material("Au")};
  specimen.substrate = Substrate{};
  const double half = 3000;  // beyond the range
  if (thickness_nm > 0)
    specimen.bodies.push_back(
        {"film", make_box({-half, -half, 0}, {half, half, thickness_nm}, 1), 1});
  Beam beam;
  beam.energy_ev = energy_ev;
  return test::yields(test::simulate(specimen, beam, test::square_scan(10, 4), electrons / 16));
}

// The range of 5 keV electrons is about 140 nm in gold (Kanaya and Okayama: 86 nm).
TEST(FilmYield, OfGoldOnSiliconRisesFromTheSubstratesToTheFilms) {
  constexpr double energy = 5000;
  const std::vector<double> thickness{0, 2, 5, 10, 20, 40, 200};
  std::vector<test::Yields> y;
  for (const double t : thickness) y.push_back(film(t, energy, 16000));
  const auto silicon = test::flat_yields("Si", energy, 0, 16000);
  const auto gold = test::flat_yields("Au", energy, 0, 16000);
  const double z = test::z_limit(12);
  const auto difference = [&](const Estimate& a, const Estimate& b) {
    return z * std::hypot(a.standard_error, b.standard_error);
  };
  EXPECT_NEAR(y.front().bse.mean, silicon.bse.mean, difference(y.front().bse, silicon.bse));
  EXPECT_NEAR(y.front().se.mean, silicon.se.mean, difference(y.front().se, silicon.se));
  EXPECT_NEAR(y.back().bse.mean, gold.bse.mean, difference(y.back().bse, gold.bse));
  EXPECT_NEAR(y.back().se.mean, gold.se.mean, difference(y.back().se, gold.se));
  for (std::size_t i = 1; i < y.size(); ++i)
    EXPECT_GT(y[i].bse.mean, y[i - 1].bse.mean - difference(y[i].bse, y[i - 1].bse))
        << thickness[i] << " nm";
  // In between it is in between, by far more than the noise.
  EXPECT_GT(y[3].bse.mean, silicon.bse.mean + 2 * difference(y[3].bse, silicon.bse));
  EXPECT_LT(y[3].bse.mean, gold.bse.mean - 2 * difference(y[3].bse, gold.bse));
}

// Below its critical thickness eta of a film rises in proportion to it (Niedrig, J. Appl. Phys. 53,
// R15 (1982)): on a substrate, the rise above the substrate's eta.
TEST(FilmYield, OfThinGoldRisesInProportionToItsThickness) {
  constexpr double energy = 20000;
  const auto base = film(0, energy, 48000), one = film(20, energy, 48000),
             two = film(40, energy, 48000);
  const double rise1 = one.bse.mean - base.bse.mean, rise2 = two.bse.mean - base.bse.mean;
  const double error = std::hypot(std::hypot(base.bse.standard_error, 2 * one.bse.standard_error),
                                  two.bse.standard_error);
  EXPECT_GT(rise1, 0.02);
  EXPECT_NEAR(rise2, 2 * rise1, test::z_limit(2) * error + 0.1 * rise2);
}

}  // namespace
}  // namespace surf::mc
