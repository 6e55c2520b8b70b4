// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/mechanism_test.h"

namespace surf::mc {

// Values of the formula as other programs' tests have them, in square angstroms.
TEST(Browning, GivesTheKnownCrossSections) {
  EXPECT_NEAR(browning_cross_section_nm2(6, 1000) * 100, 0.558167, 1e-6);
  EXPECT_NEAR(browning_cross_section_nm2(6, 20000) * 100, 0.0308131, 1e-7);
  EXPECT_NEAR(browning_cross_section_nm2(13, 1000) * 100, 1.555681, 1e-6);
  EXPECT_NEAR(browning_cross_section_nm2(79, 10000) * 100, 1.328853, 1e-6);
}

TEST(Browning, SamplesItsMixture) {
  for (const char* name : {"Si", "Au"}) {
    const Material& m = material(name);
    const auto browning = make_browning(m, m.constituents[0]);
    const double z = m.constituents[0].atomic_number;
    for (const double energy : {300.0, 2000.0, 20000.0}) {
      const double e = energy * 1e-3, a = 7e-3 / e;
      const double ratio = 300 * std::pow(e, 1 - z / 2000) / z + z * z * z / (3e5 * e);
      std::vector<double> edges;
      for (int i = 1; i < 12; ++i) edges.push_back(std::pow(i / 12.0, 3));
      expect_sampled(
          *browning, energy, 100000, edges,
          [](const ScatterEvent& s) { return (1 - s.cos_theta) / 2; },
          [&](double mu) {
            const double rutherford = mu * (1 + a) / (mu + a);
            return (ratio * rutherford + mu) / (1 + ratio);
          },
          6);
    }
  }
}

}  // namespace surf::mc
