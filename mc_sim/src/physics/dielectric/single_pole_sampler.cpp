// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/loss_quantiles.h"
#include "physics/dielectric/loss_sampler.h"
#include "physics/dielectric/pole_line.h"
#include "physics/dielectric/shells.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/physics/single_pole.h"

namespace surf::mc {
namespace {

using atomic::hartree_ev;

constexpr int steps_per_octave = 160;  // of w0, in making tables
constexpr double least_loss_ev = 0.02;
constexpr int most_draws = 16;  // of a momentum, before the next w0
constexpr int most_redraws = 1000;

class SinglePoleSampler final : public LossSampler {
 public:
  explicit SinglePoleSampler(const DielectricData& data)
      : pole_(data.elf, data.band), shells_(data),
        least_ev_(std::max(data.band.gap_ev, least_loss_ev)), losses_(data.band, least_ev_) {
    for (int i = 0; i <= EnergyBins::count; ++i) losses_.add(EnergyBins::lower_ev(i), *this);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    return pole_.inverse_mean_free_path_per_nm(energy_ev);
  }

  double stopping_power_ev_per_nm(double energy_ev) const override {
    return pole_.stopping_power_ev_per_nm(energy_ev);
  }

  bool draw(double energy_ev, RandomStream& random, Loss& loss) const override {
    if (!losses_.can_lose(energy_ev)) return false;
    for (int redraws = 0; redraws < most_redraws; ++redraws) {
      const LossQuantiles::Place p = losses_.draw(energy_ev, random, *this);
      const PoleLine line(p.loss_ev / hartree_ev);
      for (int i = 0; i < most_draws; ++i) {
        const double u = line.square_of_momentum(p.first + random.uniform() * (p.last - p.first));
        const double w = line.loss_of_square(u), q = std::sqrt(u);
        if (!(u > 0) || !is_allowed(energy_ev, w, q)) continue;
        loss = {w, q, 0, line.is_collective(q, w)};
        if (p.loss_ev > shells_.lowest_ev())
          loss.shell_ev = shells_.draw(p.loss_ev, w * hartree_ev, random.uniform());
        return true;
      }
    }
    return false;
  }

  std::size_t bytes() const override { return losses_.bytes(); }

  // What LossQuantiles asks, of w0.
  void integrate(double energy_ev, double most_ev, std::vector<double>& edges,
                 std::vector<double>& sums) const {
    for (int k = 1; edges.back() < most_ev; ++k) {
      const double from = edges.back(),
                   to = std::min(least_ev_ * std::exp2(double(k) / steps_per_octave), most_ev);
      sums.push_back(sums.back() +
                     std::log(to / from) * pole_.density_per_nm(energy_ev, std::sqrt(from * to)));
      edges.push_back(to);
    }
  }

  // Momenta as ln t of the pole line. Quantiles at the very ends may lie where none is allowed by a
  // rounding.
  LossAndRange range(double energy_ev, double w0_ev) const {
    for (const double shrink : {1.0, 1 - 1e-9, 1 - 1e-6, 1 - 1e-4, 1 - 1e-2}) {
      const double w0 = w0_ev * shrink / hartree_ev;
      const SinglePole::Momenta m = pole_.momenta(energy_ev / hartree_ev, w0);
      if (!(m.last >= m.first)) continue;
      const PoleLine line(w0);
      return LossAndRange{static_cast<float>(w0_ev), static_cast<float>(line.log_t(m.first)),
                          static_cast<float>(line.log_t(m.last))};
    }
    return LossAndRange{static_cast<float>(w0_ev), 0, 0};
  }

 private:
  bool is_allowed(double energy_ev, double w, double q) const {
    const double energy = energy_ev / hartree_ev;
    if (energy_ev - w * hartree_ev < pole_.limits().free_ev()) return false;
    const double p = atomic::momentum(energy);
    return w * (1 + (energy - 0.5 * w) / atomic::rest_energy) + 0.5 * q * q <= p * q;
  }

  SinglePole pole_;
  Shells shells_;
  double least_ev_;
  LossQuantiles losses_;  // of w0
};

}  // namespace

std::unique_ptr<const LossSampler> make_single_pole_sampler(const DielectricData& data) {
  return std::make_unique<SinglePoleSampler>(data);
}

}  // namespace surf::mc
