// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/acceptance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {
namespace {

/// A table of a function of energy and direction.
template <class Function>
Acceptance table(std::vector<double> edges_ev, const Function& f) {
  Acceptance a;
  a.energy_edges_ev = std::move(edges_ev);
  for (std::size_t e = 0; e < a.energy_bins(); ++e)
    for (int p = 0; p < a.polar_bins; ++p)
      for (int t = 0; t < a.azimuth_bins; ++t)
        a.probability.push_back(static_cast<float>(
            f(0.5 * (a.energy_edges_ev[e] + a.energy_edges_ev[e + 1]), middle_direction(a, p, t))));
  return a;
}

SimulationResult run(const std::vector<Acceptance>& tables, Method method, std::int64_t electrons) {
  SimulationOptions options;
  options.budget = ElectronsPerPixel{electrons};
  options.method = method;
  for (const Acceptance& a : tables) {
    Detector d;
    d.name = "own" + std::to_string(options.detectors.size());
    d.acceptance = std::make_shared<Acceptance>(a);
    options.detectors.push_back(d);
  }
  Specimen specimen = test::flat("Si");
  specimen.bodies.push_back({"box", make_box({-20, -20, 0}, {20, 20, 30}), 0});
  return simulate(Scene(specimen, Beam{}, test::square_scan(60, 5)), options);
}

double total(const SimulationResult& r, std::size_t detector) {
  double sum = 0;
  for (const Counts& c : r.counts[detector].data()) sum += static_cast<double>(c.sum);
  return sum;
}

TEST(Acceptance, MiddlesOfBinsLieInTheirBins) {
  Acceptance a = table({0, 50, 1000}, [](double, const Vec3&) { return 0; });
  for (std::size_t i = 0; i < a.probability.size(); ++i) {
    a.probability[i] = 1;
    const auto t = static_cast<int>(i % 72), p = static_cast<int>(i / 72 % 90);
    ASSERT_EQ(probability(a, i < 72 * 90 ? 20 : 60, middle_direction(a, p, t)), 1) << i;
    a.probability[i] = 0;
  }
  a.probability.assign(a.probability.size(), 1);
  EXPECT_EQ(probability(a, 50, {0, 0, 1}), 1);
  EXPECT_EQ(probability(a, 50, {0, 0, -1}), 1);
  EXPECT_EQ(probability(a, 1000, {0, 0, 1}), 0);  // beyond the last edge
}

TEST(Acceptance, DiceAreUniformAndOfEachStreamTheirOwn) {
  constexpr int electrons = 40'000, bins = 20;
  double both = 0;
  std::vector<double> counted(bins);
  RandomStream random(5, 1, 0);
  for (int i = 0; i < electrons; ++i) {
    const double z = 2 * random.uniform() - 1, turn = 6.283 * random.uniform();
    const double s = std::sqrt(1 - z * z), energy = 50 * random.uniform();
    const Vec3 d{s * std::cos(turn), s * std::sin(turn), z};
    for (int b = 0; b < bins; ++b)
      if (is_counted((b + 0.5) / bins, energy, d, 3)) counted[static_cast<std::size_t>(b)] += 1;
    both += is_counted(0.5, energy, d, 3) && is_counted(0.5, energy, d, 4);
  }
  for (int b = 0; b < bins; ++b) {
    const double p = (b + 0.5) / bins;
    EXPECT_NEAR(counted[static_cast<std::size_t>(b)], electrons * p,
                4.5 * std::sqrt(electrons * p * (1 - p)))
        << b;
  }
  EXPECT_NEAR(both, electrons * 0.25, 4.5 * std::sqrt(electrons * 0.25 * 0.75));
}

TEST(Acceptance, TablesThatHoldAnotherDetectorCountItsElectrons) {
  const auto in_x = [](double, const Vec3& d) { return d.x > 0; };
  const auto not_in_x = [](double, const Vec3& d) { return d.x <= 0; };
  const SimulationResult r = run({table({0, 50}, [](double, const Vec3&) { return 1; }),
                                  table({0, 50}, in_x), table({0, 50}, not_in_x)},
                                 Method::direct, 100);
  EXPECT_GT(total(r, 3), 1000);
  for (std::size_t i = 0; i < r.counts[0].size(); ++i) {
    EXPECT_EQ(r.counts[2].data()[i].sum, r.counts[test::se].data()[i].sum);
    EXPECT_EQ(r.counts[3].data()[i].sum + r.counts[4].data()[i].sum, r.counts[2].data()[i].sum);
  }
}

TEST(Acceptance, CountsAsManyAsItSaysWithBothMethods) {
  const auto share = [](double energy, const Vec3& d) { return d.z > 0 ? 0.3 + energy / 200 : 0; };
  const Acceptance own = table({0, 10, 20, 30, 40, 50}, share);
  // The expected number is that of electrons in each bin of energy, times its share.
  std::vector<Acceptance> all{own};
  for (int e = 0; e < 5; ++e)
    all.push_back(table({10.0 * e, 10.0 * e + 10}, [](double, const Vec3& d) { return d.z > 0; }));
  for (const Method method : {Method::direct, Method::replay}) {
    const SimulationResult r = run(all, method, 400);
    double expected = 0, variance = 0;
    for (std::size_t e = 0; e < 5; ++e) {
      const double p = 0.3 + (10 * static_cast<double>(e) + 5) / 200, n = total(r, 3 + e);
      expected += p * n, variance += p * (1 - p) * n;
    }
    EXPECT_GT(expected, 1000);
    EXPECT_NEAR(total(r, 2), expected, 4 * std::sqrt(variance));
  }
}

TEST(Acceptance, WrongTablesAreRefused) {
  const auto refused = [](Acceptance a) { EXPECT_THROW(validate(a, "detector own"), UsageError); };
  const Acceptance good = table({0, 50}, [](double, const Vec3&) { return 0.5; });
  EXPECT_NO_THROW(validate(good, "detector own"));
  Acceptance a = good;
  a.energy_edges_ev = {0};
  refused(a);
  a.energy_edges_ev = {50, 0};
  refused(a);
  a = good;
  a.probability.pop_back();
  refused(a);
  for (const float wrong : {-0.1f, 1.1f, std::nanf("")}) {
    a = good;
    a.probability[7] = wrong;
    refused(a);
  }
  a = good;
  a.probability[7] = 0.25f;
  EXPECT_NE(hash_of(a), hash_of(good));
  Detector d;
  d.name = "own";
  d.acceptance = std::make_shared<Acceptance>(good);
  EXPECT_TRUE(format_detector(d).ends_with(",acceptance=" + hash_of(good)));
  EXPECT_THROW(parse_detectors(format_detector(d), "--detector"), UsageError);
}

}  // namespace
}  // namespace surf::mc
