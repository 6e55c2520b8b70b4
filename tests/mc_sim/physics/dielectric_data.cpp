// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/dielectric_data.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/io/sim/materials.h"
#include "surf/mc/physics/single_pole.h"

namespace surf::mc {
namespace {

TEST(DielectricData, IsThereForEveryMaterialThatComesWithSemsurf) {
  io::MaterialLibrary library;
  for (const Material& m : library.all()) {
    const auto data = m.dielectric;
    ASSERT_TRUE(data) << m.name;
    EXPECT_FALSE(data->elf.source().empty()) << m.name;
    EXPECT_GT(data->elf.highest_ev(), 5000) << m.name;
    EXPECT_GT(data->band.filled_ev, 3) << m.name;
    EXPECT_LT(data->band.filled_ev, 50) << m.name;
    EXPECT_FALSE(data->sources.empty()) << m.name;
    const SinglePole losses(data->elf, data->band);
    double before = 0;
    for (double energy_ev = 300; energy_ev < 3e4; energy_ev *= 2) {
      const double path =
          1 / losses.inverse_mean_free_path_per_nm(energy_ev + data->band.filled_ev);
      EXPECT_GT(path, before) << m.name << ", " << energy_ev;
      before = path;
    }
  }
}

// The f-sum counts all electrons of an atom; published sums of these files (see data/README.md) are
// 0.81 to 1.07.
TEST(DielectricData, SumsCountTheElectrons) {
  io::MaterialLibrary library;
  for (const Material& m : library.all()) {
    double z = 0;
    for (const Constituent& c : m.constituents) z += c.atomic_number * atoms_per_formula_unit(m, c);
    const auto data = m.dielectric;
    EXPECT_NEAR(data->elf.electron_sum(formula_units_per_nm3(m)) / z, 0.95, 0.16) << m.name;
    EXPECT_NEAR(data->elf.above(data->band.gap_ev).screening_sum(), data->expected_screening_sum,
                0.13)
        << m.name;
  }
}

}  // namespace
}  // namespace surf::mc
