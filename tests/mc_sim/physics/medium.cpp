// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/medium.h"

#include <algorithm>

#include "physics/mechanism_test.h"

namespace surf::mc {

namespace {

class Isotropic final : public Scattering {
 public:
  explicit Isotropic(double per_nm) : per_nm_(per_nm) {}
  std::string describe() const override { return "isotropic"; }
  double inverse_mean_free_path_per_nm(double) const override { return per_nm_; }
  bool debits() const override { return false; }
  void scatter(double, RandomStream& random, ScatterEvent& event) const override {
    event.cos_theta = 1 - 2 * random.uniform();
    event.turn = random.uniform();
  }

 private:
  double per_nm_;
};

class Power final : public ContinuousLoss {
 public:
  Power(double ev_per_nm, double exponent) : ev_per_nm_(ev_per_nm), exponent_(exponent) {}
  std::string describe() const override { return "power law"; }
  double stopping_power_ev_per_nm(double e) const override {
    return ev_per_nm_ * std::pow(e / 100, exponent_);
  }

 private:
  double ev_per_nm_, exponent_;
};

Medium make(double per_nm, std::unique_ptr<const ContinuousLoss> loss, double cutoff = 4) {
  std::vector<std::unique_ptr<const Scattering>> s;
  if (per_nm > 0) s.push_back(std::make_unique<Isotropic>(per_nm));
  return {std::move(s), std::move(loss), 0, cutoff};
}

}  // namespace

TEST(EnergyBins, CoverTheirRange) {
  for (int i = 0; i + 1 < EnergyBins::count; ++i) {
    const double e = EnergyBins::lower_ev(i);
    EXPECT_EQ(EnergyBins::bin(e), i);
    EXPECT_EQ(EnergyBins::bin(std::nextafter(EnergyBins::lower_ev(i + 1), 0)), i);
    EXPECT_LT((EnergyBins::lower_ev(i + 1) - e) / e, 0.07);
  }
  EXPECT_GT(EnergyBins::lower_ev(EnergyBins::count), 30000 + 100);
  EXPECT_EQ(EnergyBins::bin(1e-9), 0);
  EXPECT_EQ(EnergyBins::bin(1e9), EnergyBins::count - 1);
}

TEST(Medium, FreePathsWithoutLossAreExponential) {
  const Medium m = make(2, nullptr);
  RandomStream random(1, 0, 0);
  std::vector<std::int64_t> counts(20);
  for (int i = 0; i < 100000; ++i) {
    const Medium::Step s = m.step(500, -std::log(random.uniform()));
    EXPECT_FALSE(s.stopped);
    EXPECT_NEAR(s.energy_ev, 500, 1e-6);
    ++counts[static_cast<std::size_t>(std::exp(-2 * s.length_nm) * 20)];
  }
  test::expect_distributed(counts, std::vector<double>(20, 5000));
}

// Energy falls along the path as the loss says, however long the path.
TEST(Medium, LosesEnergyAsIntegrated) {
  for (const double exponent : {-0.8, 0.0, 2.5}) {
    const Medium m = make(0.01, std::make_unique<Power>(5, exponent));
    double e = 800, path = 0;
    RandomStream random(1, 0, 0);
    while (e > 50) {
      const Medium::Step s = m.step(e, -std::log(random.uniform()));
      path += s.length_nm;
      EXPECT_NEAR(m.energy_after(e, s.length_nm), s.energy_ev, 1e-9 * e);
      EXPECT_NEAR(m.range_nm(e) - m.range_nm(s.energy_ev), s.length_nm, 1e-6 * (1 + s.length_nm));
      e = s.energy_ev;
    }
    const double exact =
        integral([&](double x) { return 1 / (5 * std::pow(x / 100, exponent)); }, e, 800);
    EXPECT_NEAR(path / exact, 1, 0.005) << exponent;
  }
}

TEST(Medium, StopsAtTheCutoff) {
  const Medium m = make(0, std::make_unique<Power>(5, 0), 20);
  const Medium::Step s = m.step(100, 1);
  EXPECT_TRUE(s.stopped);
  EXPECT_NEAR(s.energy_ev, 20, 1e-9);
  EXPECT_NEAR(s.length_nm, 80.0 / 5, 1e-9);
  EXPECT_NEAR(m.energy_after(100, 1000), 20, 1e-12);
}

TEST(Medium, ChoosesMechanismsByTheirRates) {
  std::vector<std::unique_ptr<const Scattering>> s;
  for (const double rate : {1.0, 3.0, 6.0}) s.push_back(std::make_unique<Isotropic>(rate));
  const Scattering* const mechanisms[] = {s[0].get(), s[1].get(), s[2].get()};
  const Medium m(std::move(s), nullptr, 0, 4);
  std::vector<std::int64_t> counts(3);
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 100000; ++i) {
    const Scattering* chosen = &m.choose(300, random.uniform());
    ++counts[static_cast<std::size_t>(std::find(mechanisms, mechanisms + 3, chosen) - mechanisms)];
  }
  test::expect_distributed(counts, {10000, 30000, 60000});
}

// The model's own promise: secondaries take up the continuous loss, no more and no less.
TEST(Medium, SecondariesTakeUpTheContinuousLoss) {
  const double start = 2000, end = 100;
  for (const char* name : {"Si", "Al", "Cu", "Au", "C"}) {
    const Medium m = make_medium(material(name), {});
    const double level = filled_level_ev(material(name), {});
    RandomStream random(1, 0, 0);
    test::Sample handed_out;
    for (int i = 0; i < 4000; ++i) {
      double energy = start, out = 0;
      for (;;) {
        const Medium::Step s = m.step(energy, -std::log(random.uniform()));
        energy = s.energy_ev;
        if (s.stopped || energy < end) break;
        ScatterEvent event;
        m.choose(energy, random.uniform()).scatter(energy, random, event);
        if (event.has_secondary) out += event.secondary_energy_ev - level;
      }
      handed_out.add(out / (start - end));
    }
    // 1 %: rates are constant within energy bins, transfers are not.
    test::expect_mean(handed_out.mean(), handed_out.standard_error(), 1, 5, 0.01);
  }
}

TEST(Medium, SecondariesNeverOutdoTheirParents) {
  for (const char* name : {"Si", "Al", "Cu", "Au", "C"}) {
    const Medium m = make_medium(material(name), {});
    RandomStream random(1, 0, 0);
    for (int i = 0; i < 200000; ++i) {
      const double energy = 4 * std::pow(7000, random.uniform());
      ScatterEvent event;
      m.choose(energy, random.uniform()).scatter(energy, random, event);
      if (event.has_secondary) {
        ASSERT_LE(event.secondary_energy_ev, energy) << name;
      }
    }
  }
}

// A mechanism that debits cannot be joined where energies are equal, whatever the loss model is.
TEST(Medium, LosesContinuouslyOnlyIfNoMechanismDebits) {
  class Debiting final : public Scattering {
   public:
    std::string describe() const override { return "debiting"; }
    double inverse_mean_free_path_per_nm(double) const override { return 1; }
    bool debits() const override { return true; }
    void scatter(double, RandomStream&, ScatterEvent& event) const override {
      event.energy_loss_ev = 1;
    }
  };
  EXPECT_TRUE(make(1, std::make_unique<Power>(5, 0)).loses_continuously());
  EXPECT_FALSE(make(1, nullptr).loses_continuously());
  std::vector<std::unique_ptr<const Scattering>> s;
  s.push_back(std::make_unique<Isotropic>(1));
  s.push_back(std::make_unique<Debiting>());
  EXPECT_FALSE(Medium(std::move(s), std::make_unique<Power>(5, 0), 0, 4).loses_continuously());
}

TEST(Medium, MechanismsDebitOnlyIfTheySaySo) {
  for (const char* name : {"Si", "Au", "PMMA"}) {
    const Medium medium = make_medium(material(name), {});
    RandomStream random(2, 3, 4);
    for (int i = 0; i < 20'000; ++i) {
      ScatterEvent event;
      const double energy = 20 + 980 * random.uniform();
      const Scattering& mechanism = medium.choose(energy, random.uniform());
      mechanism.scatter(energy, random, event);
      if (mechanism.debits()) continue;
      ASSERT_EQ(event.energy_loss_ev, 0) << mechanism.describe();
    }
    EXPECT_TRUE(medium.loses_continuously());
  }
}

}  // namespace surf::mc
