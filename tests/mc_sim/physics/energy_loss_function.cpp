// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/energy_loss_function.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "surf/core/error.h"

namespace surf::mc {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// Of Drude's electron gas: w g wp^2 / ((w^2 - wp^2)^2 + w^2 g^2). Its sums are 1, and the gas's
// electrons.
EnergyLossFunction drude(double plasmon_ev, double width_ev) {
  std::vector<double> energies, values;
  for (double w = 0.01; w < 2e4; w *= 1.02) {
    const double square = w * w - plasmon_ev * plasmon_ev;
    energies.push_back(w);
    values.push_back(w * width_ev * plasmon_ev * plasmon_ev /
                     (square * square + w * w * width_ev * width_ev));
  }
  return {energies, values};
}

template <class F>
std::string complaint(const F& f) {
  try {
    f();
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "nothing was thrown";
}

TEST(EnergyLossFunction, KeepsTheSumRulesOfAnElectronGas) {
  for (const double plasmon : {5.0, 16.0, 30.0}) {
    const EnergyLossFunction elf = drude(plasmon, 0.2 * plasmon);
    EXPECT_NEAR(elf.screening_sum(), 1, 2e-3);
    const double electrons_per_nm3 = plasmon * plasmon / 1.378843;
    EXPECT_NEAR(elf.electron_sum(electrons_per_nm3), 1, 5e-3);
    EXPECT_NEAR(elf.electron_sum(electrons_per_nm3 / 4), 4, 2e-2);
  }
}

TEST(EnergyLossFunction, InterpolatesLogarithmsAndGoesOnBeyondItsEnds) {
  const EnergyLossFunction elf({1, 10, 100}, {1, 0.01, 1e-5});
  EXPECT_DOUBLE_EQ(elf(1), 1);
  EXPECT_NEAR(elf(std::sqrt(10.0)), 0.1, 1e-12);
  EXPECT_NEAR(elf(50), 0.01 * std::pow(5, -3), 1e-12);
  EXPECT_NEAR(elf(1000), 1e-8, 1e-14);  // as over the last decade
  EXPECT_NEAR(elf(0.1), 0.1, 1e-15);
  EXPECT_EQ(elf(0), 0);
  // A tail that rises or hardly falls would make sums infinite.
  const EnergyLossFunction rising({1, 10, 100}, {1, 1, 1});
  EXPECT_NEAR(rising(1000), std::pow(10, -2.5), 1e-9);
  EXPECT_TRUE(std::isfinite(rising.electron_sum(100)));
  // A zero among the values.
  const EnergyLossFunction gap({1, 2, 3, 4}, {1, 0, 0, 2});
  EXPECT_EQ(gap(2.5), 0);
  EXPECT_NEAR(gap(std::sqrt(12.0)), 1, 1e-12);
}

TEST(EnergyLossFunction, IsNothingBelowAGap) {
  const EnergyLossFunction whole = drude(16, 3), cut = whole.above(9);
  EXPECT_EQ(cut(8.9), 0);
  EXPECT_EQ(cut(9.5), whole(9.5));
  EXPECT_LT(cut.screening_sum(), whole.screening_sum() - 0.01);
  EXPECT_GT(cut.screening_sum(), 0.5);
}

TEST(EnergyLossFunction, IsReadFromItsFile) {
  const EnergyLossFunction elf = parse_energy_loss_function(
      "# outer shells line then energy_eV,ELF ; source: a book\r\n# 1.12\t5 100 -1\n1, "
      "0.5\n2,0.25\n\n4,0\n",
      "x.csv");
  EXPECT_THAT(elf.shells_ev(), ElementsAre(1.12, 5, 100));
  EXPECT_EQ(elf.source(), "a book");
  EXPECT_EQ(elf.highest_ev(), 4);
  EXPECT_DOUBLE_EQ(elf(2), 0.25);
}

TEST(EnergyLossFunction, RefusesFilesWithTheLineThatIsWrong) {
  const std::string head = "# source: a\n# 5 -1\n";
  const auto said = [&](const std::string& rows) {
    return complaint([&] { parse_energy_loss_function(head + rows, "mine.csv"); });
  };
  EXPECT_THAT(said("1,0.5\n2;0.25\n"),
              AllOf(HasSubstr("mine.csv"), HasSubstr("line 4"), HasSubstr("no comma")));
  EXPECT_THAT(said("1,0.5\n2,x\n"), AllOf(HasSubstr("line 4"), HasSubstr("'x' is not a number")));
  EXPECT_THAT(said("1,0.5\n1,0.5\n2,1\n"), AllOf(HasSubstr("line 4"), HasSubstr("not above")));
  EXPECT_THAT(said("1,0.5\n2,-0.5\n3,1\n"), AllOf(HasSubstr("line 4"), HasSubstr("negative")));
  EXPECT_THAT(said("1,0.5\n2,nan\n3,1\n"), HasSubstr("line 4"));
  EXPECT_THAT(said("1,0.5\n2,0.5 eV\n3,1\n"), HasSubstr("line 4"));
  EXPECT_THAT(said("1,0.5\n"), HasSubstr("fewer than three"));
  EXPECT_THAT(complaint([] { parse_energy_loss_function("# s\n# 5 x\n1,1\n2,1\n3,1\n", "a"); }),
              HasSubstr("line 2"));
  EXPECT_THAT(complaint([] { EnergyLossFunction({1, 2}, {1, 1}); }), HasSubstr("fewer than three"));
  EXPECT_THAT(complaint([] { EnergyLossFunction({1, 3, 2}, {1, 1, 1}); }), HasSubstr("point 3"));
  EXPECT_THAT(complaint([] {
                EnergyLossFunction({1, 2, 3}, {1, std::numeric_limits<double>::infinity(), 1});
              }),
              HasSubstr("point 2"));
}

}  // namespace
}  // namespace surf::mc
