// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "physics/directions.h"
#include "physics/mechanisms.h"

namespace surf::mc {

namespace {

constexpr double bohr_radius_nm = 0.0529177;

// Bulk plasmons that decay into one secondary each (Quinn, Phys. Rev. 126, 1453 (1962); Kotera,
// Jpn. J. Appl. Phys. 29, 2277 (1990)). With E from the bottom of a free-electron band:
//   1/lambda = hw / (2 a0 E) ln{[sqrt(EF + hw) - sqrt(EF)] / [sqrt(E) - sqrt(E - hw)]},  E > EF +
//   hw.
// The secondary gets the plasmon's energy from the highest filled level, in any direction; the
// primary keeps its own: the continuous loss pays.
class Plasmon final : public Scattering {
 public:
  Plasmon(double plasmon_ev, double filled_level_ev)
      : plasmon_ev_(plasmon_ev), level_ev_(filled_level_ev),
        fermi_ev_(0.29436 * std::pow(plasmon_ev, 4.0 / 3.0)) {}

  std::string describe() const override {
    return fmt::format(
        "secondaries: plasmons of {:g} eV, one secondary each "
        "(doi:10.1103/PhysRev.126.1453, doi:10.1143/JJAP.29.2277)",
        plasmon_ev_);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    const double e = energy_ev - level_ev_ + fermi_ev_;
    if (e <= fermi_ev_ + plasmon_ev_) return 0.0;
    const double widest = std::sqrt(fermi_ev_ + plasmon_ev_) - std::sqrt(fermi_ev_);
    const double narrowest = std::sqrt(e) - std::sqrt(e - plasmon_ev_);
    return plasmon_ev_ / (2.0 * bohr_radius_nm * e) * std::log(widest / narrowest);
  }

  double secondary_power_ev_per_nm(double energy_ev) const override {
    return plasmon_ev_ * inverse_mean_free_path_per_nm(energy_ev);
  }

  bool takes_remaining_loss() const override { return true; }

  bool debits() const override { return false; }

  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    if (energy_ev - level_ev_ <= plasmon_ev_) return;
    event.has_secondary = true;
    event.secondary_energy_ev = plasmon_ev_ + level_ev_;
    const double cos_theta = 1.0 - 2.0 * random.uniform();
    event.secondary_direction = from_axis(cos_theta, random.uniform());
  }

 private:
  double plasmon_ev_;
  double level_ev_;
  double fermi_ev_;  // of a free-electron gas with this plasmon energy
};

}  // namespace

std::unique_ptr<const Scattering> make_plasmon(const Material& material, const Physics& physics) {
  return std::make_unique<Plasmon>(material.plasmon_ev, filled_level_ev(material, physics));
}

}  // namespace surf::mc
