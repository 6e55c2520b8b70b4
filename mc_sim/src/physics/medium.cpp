// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/medium.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/dielectric/kept_tables.h"
#include "physics/dielectric/phonons.h"
#include "physics/mechanisms.h"

namespace surf::mc {

namespace {

// Where nothing slows an electron down, a bin is as good as endless.
constexpr double endless_nm_per_ev = 1e30;

// Averages over a bin are taken along the path: weighted by dE / S.
constexpr int samples_per_bin = 8;

}  // namespace

Medium::Medium(std::vector<std::unique_ptr<const Scattering>> scatterings,
               std::unique_ptr<const ContinuousLoss> loss, double barrier_ev, double cutoff_ev)
    : scatterings_(std::move(scatterings)), loss_(std::move(loss)),
      loses_in_events_(
          !loss_ && std::ranges::any_of(scatterings_, [](const auto& s) { return s->debits(); })),
      barrier_ev_(barrier_ev), cutoff_ev_(std::max(cutoff_ev, EnergyBins::lowest_ev)),
      cutoff_bin_(EnergyBins::bin(cutoff_ev_)), bins_(EnergyBins::count),
      cumulative_(EnergyBins::count * scatterings_.size()) {
  const std::size_t n = scatterings_.size();
  std::vector<double> rate(n);
  for (int i = 0; i < EnergyBins::count; ++i) {
    const double lower = std::max(EnergyBins::lower_ev(i), i == cutoff_bin_ ? cutoff_ev_ : 0.0);
    const double width = EnergyBins::lower_ev(i + 1) - lower;
    std::fill(rate.begin(), rate.end(), 0.0);
    double slowness = 0;
    for (int s = 0; s < samples_per_bin; ++s) {
      const double energy = lower + (s + 0.5) / samples_per_bin * width;
      const double power = loss_ ? loss_->stopping_power_ev_per_nm(energy) : 0.0;
      const double weight = std::min(1.0 / power, endless_nm_per_ev) / samples_per_bin;
      slowness += weight;
      const RateFactors factors = rate_factors(energy, power);
      for (std::size_t k = 0; k < n; ++k) {
        const Scattering& m = *scatterings_[k];
        const double factor = m.secondary_power_ev_per_nm(energy) <= 0 ? 1.0
                              : m.takes_remaining_loss()               ? factors.flexible
                                                                       : factors.fixed;
        rate[k] += weight * factor * m.inverse_mean_free_path_per_nm(energy);
      }
    }
    double total = 0;
    for (double& r : rate) total += (r /= slowness);
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      sum += rate[k];
      cumulative_[static_cast<std::size_t>(i) * n + k] =
          total > 0 ? static_cast<float>(sum / total) : 1.0f;
    }
    bins_[static_cast<std::size_t>(i)] = {
        lower, slowness, 1.0 / slowness, total, total > 0 ? 1.0 / total : 0.0, 0.0, slowness};
  }
  for (int i = cutoff_bin_ + 1; i < EnergyBins::count; ++i) {
    const Bin& below = bins_[static_cast<std::size_t>(i - 1)];
    Bin& bin = bins_[static_cast<std::size_t>(i)];
    bin.range_nm = below.range_nm + (bin.lower_ev - below.lower_ev) * below.nm_per_ev;
  }
}

// Secondaries are not debited from the electron that makes them: the continuous loss pays. So what
// the mechanisms hand out has to be that loss, on average. Where their published rates cost more
// (below some 100 eV, where cascades would grow out of nothing), all are scaled down alike. Where
// they cost less, the rest goes to the mechanisms that take it: generation then follows the
// stopping power, the principle of Salow and Bethe (Lin and Joy, Surf. Interface Anal. 37, 895
// (2005)).
Medium::RateFactors Medium::rate_factors(double energy_ev, double power_ev_per_nm) const {
  double fixed = 0, flexible = 0;
  for (const auto& s : scatterings_)
    (s->takes_remaining_loss() ? flexible : fixed) += s->secondary_power_ev_per_nm(energy_ev);
  const double cost = fixed + flexible;
  if (!loss_ || cost <= 0) return {1, 1};
  if (cost > power_ev_per_nm) return {power_ev_per_nm / cost, power_ev_per_nm / cost};
  return {1, flexible > 0 ? (power_ev_per_nm - fixed) / flexible : 1};
}

double Medium::energy_after(double energy_ev, double length_nm) const {
  for (int i = EnergyBins::bin(energy_ev); i >= cutoff_bin_; --i) {
    const Bin& bin = bins_[static_cast<std::size_t>(i)];
    const double to_edge = (energy_ev - bin.lower_ev) * bin.nm_per_ev;
    if (length_nm < to_edge) return energy_ev - length_nm * bin.ev_per_nm;
    length_nm -= to_edge;
    energy_ev = bin.lower_ev;
  }
  return cutoff_ev_;
}

bool Medium::loses_continuously() const {
  return loss_ && std::ranges::none_of(scatterings_, [](const auto& s) { return s->debits(); });
}

void Medium::set_range(const std::vector<double>& at_edges) {
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    Bin& bin = bins_[i];
    const double upper_ev = EnergyBins::lower_ev(static_cast<int>(i) + 1);
    bin.range_nm = at_edges[i];
    bin.range_nm_per_ev = std::max(0.0, at_edges[i + 1] - at_edges[i]) / (upper_ev - bin.lower_ev);
  }
}

double Medium::stopping_power_ev_per_nm(double energy_ev) const {
  return loss_ ? loss_->stopping_power_ev_per_nm(energy_ev) : 0.0;
}

double Medium::inverse_mean_free_path_per_nm(double energy_ev) const {
  double sum = 0;
  for (const auto& s : scatterings_) sum += s->inverse_mean_free_path_per_nm(energy_ev);
  return sum;
}

std::vector<std::string> Medium::describe() const {
  std::vector<std::string> lines;
  for (const auto& s : scatterings_) lines.push_back(s->describe());
  if (loss_) lines.push_back(loss_->describe());
  return lines;
}

namespace {

using Scatterings = std::vector<std::unique_ptr<const Scattering>>;

Scatterings elastic_of(const Material& material, const Physics& physics) {
  Scatterings atoms;
  for (const Constituent& c : material.constituents)
    atoms.push_back(physics.elastic == ElasticModel::browning
                        ? make_browning(material, c)
                        : make_mott(material, c, physics.atoms));
  if (physics.elastic != ElasticModel::mott_phonon) return atoms;
  return fade(make_acoustic_phonons(material, *material.dielectric, is_dielectric(physics)),
              std::move(atoms));
}

}  // namespace

Medium make_medium(const Material& material, const Physics& physics) {
  validate(physics);
  Scatterings scatterings = elastic_of(material, physics);
  std::unique_ptr<const ContinuousLoss> loss;
  if (is_dielectric(physics)) {
    const DielectricData& data = *material.dielectric;
    scatterings.push_back(make_dielectric(material, physics));
    for (const OpticalMode& mode : data.optical)
      scatterings.push_back(make_optical_phonons(mode, data));
    if (data.trap_per_nm > 0) scatterings.push_back(make_polaron_traps(data));
  } else {
    if (physics.secondaries) {
      if (material.valence_electrons > 0) scatterings.push_back(make_moller(material, physics));
      if (material.plasmon_ev > 0) scatterings.push_back(make_plasmon(material, physics));
    }
    if (physics.loss == LossModel::joy_luo) loss = make_joy_luo(material, physics);
  }
  Medium medium(std::move(scatterings), std::move(loss), effective_barrier_ev(physics, material),
                effective_cutoff_ev(physics, material));
  if (is_dielectric(physics)) medium.set_range(kept_reach_nm(medium, material, physics));
  return medium;
}

}  // namespace surf::mc
