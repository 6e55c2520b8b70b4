// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/kept_tables.h"
#include "physics/dielectric/loss_sampler.h"
#include "physics/dielectric/shells.h"
#include "physics/directions.h"
#include "physics/mechanisms.h"
#include "surf/core/error.h"

namespace surf::mc {
namespace {

using atomic::hartree_ev;

constexpr double largest_auger_binding_ev = 3000;  // deeper holes rather shine

// Losses to electrons, each one paid by the electron that makes it. An event frees one electron: of
// the valence band, or of an inner shell. Those of the valence band start from a state E_i that the
// loss w lifts above the filled band and the gap, with the weight of free electrons' states,
// sqrt(E_i (E_i + w)). A plasmon decays into any direction; where a single electron of the gas can
// take loss and momentum, it does, and momentum is conserved. Holes stay, or an Auger electron
// fills those of inner shells.
class Dielectric final : public Scattering {
 public:
  Dielectric(const DielectricData& data, std::shared_ptr<const LossSampler> losses,
             const Physics& physics)
      : band_(data.band), top_ev_(data.elf.highest_ev()), losses_(std::move(losses)), shells_(data),
        secondaries_(physics.secondaries), auger_(physics.auger), model_(physics.inelastic_model) {}

  std::string describe() const override {
    return fmt::format(
        "losses: energy-loss function to {:.4g} eV, {}, tables of {:.1f} MB{}{}", top_ev_,
        model_ == InelasticModel::single_pole
            ? "extended by a single pole (doi:10.1103/PhysRevB.35.482)"
            : "full Penn algorithm (doi:10.1002/sia.5789)",
        static_cast<double>(losses_->bytes()) / 1e6,
        secondaries_ ? "; each frees one electron" : "",
        secondaries_ && auger_ ? ", and holes of inner shells an Auger electron" : "");
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    return losses_->inverse_mean_free_path_per_nm(energy_ev);
  }

  bool debits() const override { return true; }

  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    Loss loss;
    if (!losses_->draw(energy_ev, random, loss)) return;
    const double energy = energy_ev / hartree_ev, q = loss.momentum;
    const double before2 = atomic::squared_momentum(energy),
                 after2 = atomic::squared_momentum(energy - loss.energy);
    const double before = std::sqrt(before2);
    event.cos_theta =
        std::clamp((before2 + after2 - q * q) / (2 * before * std::sqrt(after2)), -1.0, 1.0);
    event.turn = random.uniform();
    event.energy_loss_ev = loss.energy * hartree_ev;
    if (!secondaries_) return;
    event.has_secondary = true;
    if (loss.shell_ev > 0) return free_inner(loss.shell_ev, random, event);
    const double cos_of_q = std::clamp((before2 + q * q - after2) / (2 * before * q), -1.0, 1.0);
    free_valence(loss, cos_of_q, random, event);
  }

 private:
  static Vec3 anywhere(RandomStream& random) {
    const double cos_theta = 1 - 2 * random.uniform();
    return from_axis(cos_theta, random.uniform());
  }

  // Draws E_i in [least, filled].
  double initial_ev(double least, double w, RandomStream& random) const {
    const double most = band_.filled_ev, highest = most * (most + w);
    for (;;) {
      const double e = least + random.uniform() * (most - least);
      const double u = random.uniform();
      if (u * u * highest <= e * (e + w)) return e;
    }
  }

  void free_valence(const Loss& loss, double cos_of_q, RandomStream& random,
                    ScatterEvent& event) const {
    const double w = event.energy_loss_ev;
    double least = std::max(0.0, band_.free_ev() - w);
    bool binary = false;
    if (!loss.collective) {
      const double slowest =
          0.5 * (2 * loss.energy - loss.momentum * loss.momentum) / loss.momentum;
      const double needed = 0.5 * slowest * slowest * hartree_ev;
      if (needed < band_.filled_ev) {
        least = std::max(least, needed);
        binary = true;
      }
    }
    const double e = initial_ev(least, w, random) + w;
    event.secondary_energy_ev = e;
    if (!binary) {
      event.secondary_direction = anywhere(random);
      return;
    }
    const double final = std::sqrt(2 * e / hartree_ev), q = loss.momentum;
    const double cos_to_q = std::clamp((2 * loss.energy + q * q) / (2 * q * final), -1.0, 1.0);
    const Vec3 along_q = from_axis(cos_of_q, event.turn + 0.5);
    event.secondary_direction = deflected(along_q, cos_to_q, random.uniform());
  }

  void free_inner(double binding_ev, RandomStream& random, ScatterEvent& event) const {
    event.secondary_energy_ev = band_.filled_ev - binding_ev + event.energy_loss_ev;
    event.secondary_direction = anywhere(random);
    if (!auger_ || binding_ev > largest_auger_binding_ev) return;
    const double next = shells_.next_ev(binding_ev);
    // Both electrons from the next shell, or from the valence band.
    const double from = next > 0 ? 2 * (band_.filled_ev - next)
                                 : initial_ev(0, 0, random) + initial_ev(0, 0, random);
    const double energy = from + binding_ev - band_.filled_ev;
    if (!(energy > band_.free_ev())) return;
    event.auger_energy_ev = energy;
    event.auger_direction = anywhere(random);
  }

  BandLimits band_;
  double top_ev_;  // of the energy-loss function
  std::shared_ptr<const LossSampler> losses_;
  Shells shells_;
  bool secondaries_, auger_;
  InelasticModel model_;
};

}  // namespace

std::unique_ptr<const Scattering> make_dielectric(const Material& material,
                                                  const Physics& physics) {
  return std::make_unique<Dielectric>(*material.dielectric, kept_losses(material, physics),
                                      physics);
}

}  // namespace surf::mc
