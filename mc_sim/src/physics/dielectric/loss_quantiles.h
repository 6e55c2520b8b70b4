// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "surf/core/random.h"
#include "surf/mc/physics/dielectric_data.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {

/// Where the quantiles of a distribution with long tails are kept: their spacing shrinks towards
/// both ends.
struct Quantiles {
  static constexpr int cells = 512;
  static constexpr int points = cells + 1;

  /// The share of probability below point i.
  static double probability(int i) {
    const double u = double(i) / cells;
    return u < 0.5 ? 2 * u * u : 1 - 2 * (1 - u) * (1 - u);
  }
  /// The place of a quantile among the points.
  static double place(double probability) {
    const double nearer = std::sqrt(0.5 * std::fmin(probability, 1 - probability));
    return (probability < 0.5 ? nearer : 1 - nearer) * cells;
  }
};

/// The quantiles of a density that is given by its integrals over steps: `sums[k]` is that up to
/// `edges[k]`, from 0.
std::vector<double> quantiles_of(std::span<const double> edges, std::span<const double> sums);

/// A loss, and which momenta go with it, by its first and its last as the sampler counts them.
struct LossAndRange {
  float loss_ev, first, last;
};

/// Losses by their quantiles at the edges of the energy bins, each with its range of momenta.
/// Between two energies and two quantiles both are interpolated, in proportion to the energy, which
/// keeps the largest loss exact.
class LossQuantiles {
 public:
  LossQuantiles(const BandLimits& band, double least_ev)
      : free_ev_(band.free_ev()), least_ev_(least_ev) {}

  /// Whether anything can be lost at an energy.
  bool can_lose(double energy_ev) const { return energy_ev - free_ev_ > least_ev_; }

  /// Adds the next edge, from the lowest energy. `model.integrate(energy_ev, most_ev, edges, sums)`
  /// adds the integrals of the density from the least loss on; `model.range(energy_ev, loss_ev)` is
  /// a LossAndRange. Returns the whole integral, 0 where nothing can be lost.
  template <class Model>
  double add(double energy_ev, const Model& model) {
    const double most_ev = energy_ev - free_ev_;
    if (!(most_ev > least_ev_ * (1 + 1e-6))) {
      ++without_;
      return 0;
    }
    std::vector<double> edges{least_ev_}, sums{0};
    model.integrate(energy_ev, most_ev, edges, sums);
    for (const double loss_ev : quantiles_of(edges, sums))
      points_.push_back(model.range(energy_ev, loss_ev));
    return sums.back();
  }

  struct Place {
    double loss_ev, first, last;
  };
  /// Draws a loss where one can be lost.
  template <class Model>
  Place draw(double energy_ev, RandomStream& random, const Model& model) const {
    const int bin = EnergyBins::bin(energy_ev);
    const double place = Quantiles::place(random.uniform());
    const int cell = std::min(static_cast<int>(place), Quantiles::cells - 1);
    const double part = place - cell;
    const auto at = [&](int edge) {
      const LossAndRange* const t =
          points_.data() + static_cast<std::size_t>(edge - without_) * Quantiles::points + cell;
      const auto mix = [&](float x, float y) { return x + part * (y - x); };
      return Place{mix(t[0].loss_ev, t[1].loss_ev), mix(t[0].first, t[1].first),
                   mix(t[0].last, t[1].last)};
    };
    Place p = at(std::max(bin + 1, without_));
    if (bin >= without_) {
      const Place lower = at(bin);
      const double from = EnergyBins::lower_ev(bin), to = EnergyBins::lower_ev(bin + 1),
                   share = (energy_ev - from) / (to - from);
      return {lower.loss_ev + share * (p.loss_ev - lower.loss_ev),
              lower.first + share * (p.first - lower.first),
              lower.last + share * (p.last - lower.last)};
    }
    // The bin in which losses begin: they shrink with what there is.
    const double top_ev = EnergyBins::lower_ev(without_) - free_ev_;
    p.loss_ev = least_ev_ +
                (p.loss_ev - least_ev_) * (energy_ev - free_ev_ - least_ev_) / (top_ev - least_ev_);
    const LossAndRange exact = model.range(energy_ev, p.loss_ev);
    return {p.loss_ev, exact.first, exact.last};
  }

  std::size_t bytes() const { return points_.size() * sizeof(LossAndRange); }

 private:
  double free_ev_, least_ev_;
  int without_ = 0;                   // edges of energy bins below all losses
  std::vector<LossAndRange> points_;  // [edge, from `without_`][quantile]
};

}  // namespace surf::mc
