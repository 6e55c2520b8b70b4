// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "physics/directions.h"
#include "physics/mechanisms.h"

namespace surf::mc {

namespace {

constexpr double pi_e4_ev2_nm2 = 6.5141e-14 * 1e14;

// Collisions with valence electrons, as in MONSEL (Lowney, Scanning 18, 301 (1996); Reimer 1985).
// E is the energy above the highest filled level, eps = dE / E the fraction handed over:
//   d sigma / d eps = (pi e^4 / E^2) [1/eps^2 + 1/(1-eps)^2 - 1/(eps (1-eps))],  W/E <= eps <= 1/2.
// Less than the work function W never lets the secondary leave. The secondary starts from the
// highest filled level. The primary keeps its energy: the continuous loss pays for the event.
class Moller final : public Scattering {
 public:
  Moller(double electrons_per_nm3, double work_function_ev, double filled_level_ev)
      : electrons_per_nm3_(electrons_per_nm3), least_ev_(work_function_ev),
        level_ev_(filled_level_ev) {}

  std::string describe() const override {
    return fmt::format(
        "secondaries: Moeller collisions with {:.1f} valence electrons per nm^3, "
        "handing over {:g} eV or more (doi:10.1002/sca.1996.4950180406)",
        electrons_per_nm3_, least_ev_);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    const double e = energy_ev - level_ev_;
    if (e <= 2.0 * least_ev_) return 0.0;
    const double x = least_ev_ / e;
    const double integral = 1.0 / x - 1.0 / (1.0 - x) - std::log(1.0 / x - 1.0);
    return electrons_per_nm3_ * pi_e4_ev2_nm2 / (e * e) * integral;
  }

  double secondary_power_ev_per_nm(double energy_ev) const override {
    const double e = energy_ev - level_ev_;
    if (e <= 2.0 * least_ev_) return 0.0;
    const auto moment = [](double x) {  // integral of eps times the density
      return std::log(x) + 1.0 / (1.0 - x) + 2.0 * std::log(1.0 - x);
    };
    return electrons_per_nm3_ * pi_e4_ev2_nm2 / e * (moment(0.5) - moment(least_ev_ / e));
  }

  bool debits() const override { return false; }

  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    const double e = energy_ev - level_ev_;
    if (e <= 2.0 * least_ev_) return;
    // Draw from 1/eps^2 and accept with f eps^2 = 1 - q + q^2, q = eps / (1 - eps), within 3/4
    // to 1.
    const double most = e / least_ev_;
    double eps, q;
    do {
      eps = 1.0 / (2.0 + (most - 2.0) * random.uniform());
      q = eps / (1.0 - eps);
    } while (random.uniform() > 1.0 - q + q * q);
    event.cos_theta = std::sqrt(1.0 - eps);
    event.turn = random.uniform();
    event.has_secondary = true;
    event.secondary_energy_ev = eps * e + level_ev_;
    event.secondary_direction = from_axis(std::sqrt(eps), event.turn + 0.5);
  }

 private:
  double electrons_per_nm3_;
  double least_ev_;
  double level_ev_;
};

}  // namespace

std::unique_ptr<const Scattering> make_moller(const Material& material, const Physics& physics) {
  return std::make_unique<Moller>(formula_units_per_nm3(material) * material.valence_electrons,
                                  material.work_function_ev, filled_level_ev(material, physics));
}

}  // namespace surf::mc
