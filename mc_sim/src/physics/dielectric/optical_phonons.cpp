// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/phonons.h"

namespace surf::mc {
namespace {

// Emission of longitudinal optical phonons (Froehlich; Llacer and Garwin, J. Appl. Phys. 40, 2766
// (1969), as in Ganachaud and Mokrani, Surf. Sci. 334, 329 (1995),
// doi:10.1016/0039-6028(95)00474-2). With x = hw / E, E from the bottom of the conduction band:
//   1/lambda = (1/2) (1 + n) (1/eps_high - 1/eps_low) (x / a0) ln{[1 + sqrt(1 - x)] / [1 - sqrt(1 -
//   x)]}, cos theta = B + (2 - x) (1 - B) / (2 sqrt(1 - x)),   B = {[2 - x + 2 sqrt(1 - x)] / [2 -
//   x - 2 sqrt(1 - x)]}^r.
// Absorption, rarer by n / (1 + n), is left out.
class OpticalPhonons final : public Scattering {
 public:
  OpticalPhonons(const OpticalMode& mode, double zero_ev) : mode_(mode), zero_ev_(zero_ev) {}

  std::string describe() const override {
    return fmt::format(
        "longitudinal optical phonons of {:g} eV, permittivity {:g} above and {:g} below "
        "(doi:10.1016/0039-6028(95)00474-2)",
        mode_.energy_ev, mode_.high_permittivity, mode_.low_permittivity);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    const double x = mode_.energy_ev / (energy_ev - zero_ev_);
    if (!(x > 0 && x < 1)) return 0;
    const double root = std::sqrt(1 - x), n = 1 / std::expm1(mode_.energy_ev / room_temperature_ev);
    return 0.5 * (1 + n) * (1 / mode_.high_permittivity - 1 / mode_.low_permittivity) * x /
           atomic::bohr_nm * std::log((1 + root) / (1 - root));
  }

  bool debits() const override { return true; }

  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    const double x = mode_.energy_ev / (energy_ev - zero_ev_);
    if (!(x > 0 && x < 1)) return;
    const double root = std::sqrt(1 - x);
    // (2 - x + 2 root) (2 - x - 2 root) = x^2
    const double ratio = (2 - x + 2 * root) / x;
    const double b = std::pow(ratio * ratio, random.uniform());
    event.cos_theta = std::clamp(b + (2 - x) * (1 - b) / (2 * root), -1.0, 1.0);
    event.turn = random.uniform();
    event.energy_loss_ev = mode_.energy_ev;
  }

 private:
  OpticalMode mode_;
  double zero_ev_;
};

}  // namespace

std::unique_ptr<const Scattering> make_optical_phonons(const OpticalMode& mode,
                                                       const DielectricData& data) {
  return std::make_unique<OpticalPhonons>(mode, data.band.free_ev());
}

}  // namespace surf::mc
