// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "physics/mechanisms.h"

namespace surf::mc {

// Browning et al., J. Appl. Phys. 76, 2016 (1994), doi:10.1063/1.357669: a fit to Mott
// cross-sections for 0.1 to 30 keV and Z up to 92. It is made for transport: the total
// cross-section itself is up to twice too large. Energies in keV.
double browning_cross_section_nm2(int atomic_number, double energy_ev) {
  const double z = atomic_number;
  const double e = energy_ev * 1e-3;
  const double root = std::sqrt(e);
  const double z17 = std::pow(z, 1.7);
  return 1e14 * 3.0e-18 * z17 / (e + 0.005 * z17 * root + 0.0007 * z * z / root);
}

namespace {

// Of the Rutherford-like part over the isotropic one. The paper's exponent 1 - Z/2000; some codes
// drop it and are 9 % off for gold at 30 keV.
double ratio_of_parts(int z, double e) {
  return 300.0 * std::pow(e, 1.0 - z / 2000.0) / z + static_cast<double>(z) * z * z / (3e5 * e);
}

}  // namespace

double browning_transport_cross_section_nm2(int z, double energy_ev) {
  const double e = energy_ev * 1e-3, ratio = ratio_of_parts(z, e), a = 7.0e-3 / e;
  const double forward = 2 * a * ((1 + a) * std::log((1 + a) / a) - 1);
  return browning_cross_section_nm2(z, energy_ev) * (ratio * forward + 1) / (1 + ratio);
}

namespace {

// A mixture of Rutherford-like and isotropic scattering.
class Browning final : public Scattering {
 public:
  Browning(int atomic_number, double atoms_per_nm3)
      : z_(atomic_number), atoms_per_nm3_(atoms_per_nm3) {}

  std::string describe() const override {
    return fmt::format(
        "elastic, Z = {}: Browning's fit to Mott cross-sections, 100 eV to 30 keV "
        "(doi:10.1063/1.357669)",
        z_);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    return atoms_per_nm3_ * browning_cross_section_nm2(z_, energy_ev);
  }

  bool debits() const override { return false; }

  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    const double e = energy_ev * 1e-3;
    const double ratio = ratio_of_parts(z_, e);
    const double u = random.uniform();
    if (random.uniform() * (1.0 + ratio) < ratio) {
      const double a = 7.0e-3 / e;
      event.cos_theta = 1.0 - 2.0 * a * u / (1.0 + a - u);
    } else {
      event.cos_theta = 1.0 - 2.0 * u;
    }
    event.turn = random.uniform();
  }

 private:
  int z_;
  double atoms_per_nm3_;
};

}  // namespace

std::unique_ptr<const Scattering> make_browning(const Material& material, const Constituent& c) {
  return std::make_unique<Browning>(c.atomic_number, number_density_per_nm3(material, c));
}

}  // namespace surf::mc
