// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "physics/mechanisms.h"

namespace surf::mc {

namespace {

// Bethe's loss with Joy and Luo's effective ionization energy (Scanning 11, 176 (1989),
// doi:10.1002/sca.4950110404), MONSEL's k, so that the loss vanishes 1 eV above the zero level:
//   S = 7850 eV/nm  rho Z / (A E)  ln[1.166 (E - zero - 1 eV) / J + 1]      (sum over constituents)
// Below E_b it goes on as E^(5/2) (Nieminen, Scanning Microsc. 2, 1917 (1988)), value continuous.
class JoyLuo final : public ContinuousLoss {
 public:
  JoyLuo(const Material& material, double zero_ev, double join_ev)
      : material_(material), zero_ev_(zero_ev), join_ev_(join_ev),
        power_at_join_(joy_luo(join_ev_)) {}

  std::string describe() const override {
    return fmt::format(
        "continuous loss: Joy-Luo with MONSEL's k (doi:10.1002/sca.4950110404); as "
        "E^(5/2) below E_b = {:g} eV ({})",
        join_ev_,
        join_ev_ < material_.loss_join_ev ? "no secondaries"
        : material_.loss_join_fitted      ? "fitted to measured SE yields"
                                          : "not fitted");
  }

  double stopping_power_ev_per_nm(double energy_ev) const override {
    if (energy_ev >= join_ev_) return joy_luo(energy_ev);
    return power_at_join_ * std::pow(energy_ev / join_ev_, 2.5);
  }

 private:
  double joy_luo(double energy_ev) const {
    double sum = 0;
    for (const Constituent& c : material_.constituents) {
      sum +=
          c.weight_fraction * c.atomic_number / c.atomic_weight *
          std::log(1.166 * std::max(energy_ev - zero_ev_ - 1.0, 0.0) / c.mean_ionization_ev + 1.0);
    }
    return 7850.0 * material_.density_g_cm3 / energy_ev * sum;
  }

  Material material_;
  double zero_ev_;
  double join_ev_;
  double power_at_join_;
};

}  // namespace

std::unique_ptr<const ContinuousLoss> make_joy_luo(const Material& material,
                                                   const Physics& physics) {
  // With the barrier off energies count from the vacuum level, as in the original MONSEL, whose
  // loss then vanishes at the work function plus 1 eV.
  const bool off = physics.barrier == BarrierModel::off;
  // E_b belongs to the secondary-electron model: without secondaries the loss above 50 eV is plain
  // Joy-Luo.
  const double join = physics.secondaries ? material.loss_join_ev
                                          : std::min(material.loss_join_ev, se_bse_split_ev);
  return std::make_unique<JoyLuo>(material, off ? material.work_function_ev : material.barrier_ev,
                                  join);
}

}  // namespace surf::mc
