// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "physics/dielectric/phonons.h"

namespace surf::mc {
namespace {

// Slow electrons of an insulator are trapped where they polarise the lattice around them (Ganachaud
// and Mokrani, Surf. Sci. 334, 329 (1995), doi:10.1016/0039-6028(95)00474-2): 1 / lambda = P exp(-E
// / E_t), E from the bottom of the conduction band. What is left of the electron's energy stays
// there.
class PolaronTraps final : public Scattering {
 public:
  explicit PolaronTraps(const DielectricData& data)
      : per_nm_(data.trap_per_nm), trap_ev_(data.trap_ev), zero_ev_(data.band.free_ev()) {}

  std::string describe() const override {
    return fmt::format(
        "polaron traps: {:g} per nm, falling by e every {:g} eV (doi:10.1016/0039-6028(95)00474-2)",
        per_nm_, trap_ev_);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    return per_nm_ * std::exp(-std::fmax(0, energy_ev - zero_ev_) / trap_ev_);
  }

  bool debits() const override { return true; }

  void scatter(double energy_ev, RandomStream&, ScatterEvent& event) const override {
    event.energy_loss_ev = energy_ev;
  }

 private:
  double per_nm_, trap_ev_, zero_ev_;
};

}  // namespace

std::unique_ptr<const Scattering> make_polaron_traps(const DielectricData& data) {
  return std::make_unique<PolaronTraps>(data);
}

}  // namespace surf::mc
