// SPDX-License-Identifier: GPL-3.0-or-later
#include "csv.h"
#include "physics/mechanism_test.h"

namespace surf::mc {

TEST(JoyLuo, GivesTheReferenceStoppingPowers) {
  Physics physics;
  physics.barrier = BarrierModel::off;  // as the reference counts energy
  physics.secondaries = false;          // plain Joy-Luo down to 50 eV
  const int energies[] = {200, 500, 1000, 2000, 5000, 10000, 20000, 30000};
  for (const auto& row : test::read_reference("stopping_joyluo.csv")) {
    const std::string& name = row.at("element");
    if (name != "Si" && name != "Al" && name != "Cu" && name != "Au") continue;
    const auto loss = make_joy_luo(material(name.c_str()), physics);
    for (const int e : energies) {
      const double expected = test::number(row, "S_" + std::to_string(e) + "eV_eV_per_nm");
      EXPECT_NEAR(loss->stopping_power_ev_per_nm(e) / expected, 1, 0.01) << name << " " << e;
    }
  }
}

TEST(JoyLuo, GoesOnAsAPowerBelowTheJoin) {
  const Material& si = material("Si");
  const auto loss = make_joy_luo(si, {});
  const double join = si.loss_join_ev;
  EXPECT_NEAR(loss->stopping_power_ev_per_nm(join - 1e-9),
              loss->stopping_power_ev_per_nm(join + 1e-9), 1e-6);
  EXPECT_NEAR(loss->stopping_power_ev_per_nm(join / 2) / loss->stopping_power_ev_per_nm(join),
              std::pow(0.5, 2.5), 1e-9);
}

}  // namespace surf::mc
