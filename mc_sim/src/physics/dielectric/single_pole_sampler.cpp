// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/loss_sampler.h"
#include "physics/dielectric/pole_line.h"
#include "physics/dielectric/quantile_table.h"
#include "physics/dielectric/shells.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/physics/single_pole.h"

namespace surf::mc {
namespace {

using atomic::hartree_ev;

constexpr int steps_per_octave = 160;   // of w0, in making tables
constexpr double least_loss_ev = 0.02;
constexpr int most_draws = 16;          // of a momentum, before the next w0

// Tables at the edges of the energy bins: quantiles of w0, and at each the range of momenta as ln t of the pole line. Between
// two energies and two quantiles both are interpolated, in proportion to the energy, which keeps the largest loss exact.
class SinglePoleSampler final : public LossSampler {
 public:
  explicit SinglePoleSampler(const DielectricData& data) : pole_(data.elf, data.band), shells_(data) {
    const BandLimits& band = data.band;
    least_ev_ = std::max(band.gap_ev, least_loss_ev);
    const double top_ev = EnergyBins::lower_ev(EnergyBins::count);
    const int steps = static_cast<int>(steps_per_octave * std::log2(top_ev / least_ev_));
    std::vector<double> edges, sums;
    for (int i = 0; i <= EnergyBins::count; ++i) {
      const double energy_ev = EnergyBins::lower_ev(i), most_ev = energy_ev - band.filled_ev - band.gap_ev;
      if (!(most_ev > least_ev_ * (1 + 1e-6))) {
        ++without_;
        continue;
      }
      edges.assign(1, least_ev_), sums.assign(1, 0);
      // As many steps as for all energies, but the last: it ends where the losses do.
      for (int k = 1; k <= steps; ++k) {
        const double from = edges.back();
        const double to = std::min(least_ev_ * std::exp2(double(k) / steps_per_octave), most_ev);
        if (!(to > from)) break;
        sums.push_back(sums.back() + std::log(to / from) * pole_.density_per_nm(energy_ev, std::sqrt(from * to)));
        edges.push_back(to);
      }
      for (const double w0_ev : quantiles_of(edges, sums)) points_.push_back(point(energy_ev, w0_ev));
    }
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override { return pole_.inverse_mean_free_path_per_nm(energy_ev); }

  double stopping_power_ev_per_nm(double energy_ev) const override { return pole_.stopping_power_ev_per_nm(energy_ev); }

  bool draw(double energy_ev, RandomStream& random, Loss& loss) const override {
    const BandLimits& band = pole_.limits();
    const double most_ev = energy_ev - band.filled_ev - band.gap_ev;
    if (!(most_ev > least_ev_)) return false;
    const int bin = EnergyBins::bin(energy_ev);
    const double from = EnergyBins::lower_ev(bin), to = EnergyBins::lower_ev(bin + 1);
    const auto table = [&](int i) { return points_.data() + static_cast<std::size_t>(i - without_) * Quantiles::points; };
    for (int redraws = 0; redraws < 1000; ++redraws) {
      const double place = Quantiles::place(random.uniform());
      const int cell = std::min(static_cast<int>(place), Quantiles::cells - 1);
      const double part = place - cell;
      const auto at = [&](const Point* t) {
        const Point &a = t[cell], &b = t[cell + 1];
        const auto mix = [&](float x, float y) { return x + part * (y - x); };
        return Place{mix(a.w0_ev, b.w0_ev), mix(a.log_t_first, b.log_t_first), mix(a.log_t_last, b.log_t_last)};
      };
      Place p = at(table(std::max(bin + 1, without_)));
      if (bin >= without_) {
        const Place lower = at(table(bin));
        const double share = (energy_ev - from) / (to - from);
        p = {lower.w0_ev + share * (p.w0_ev - lower.w0_ev), lower.first + share * (p.first - lower.first),
             lower.last + share * (p.last - lower.last)};
      } else {   // the bin in which losses begin: they shrink with what there is
        const double top_ev = EnergyBins::lower_ev(without_) - band.filled_ev - band.gap_ev;
        p.w0_ev = least_ev_ + (p.w0_ev - least_ev_) * (most_ev - least_ev_) / (top_ev - least_ev_);
        const Point exact = point(energy_ev, p.w0_ev);
        p.first = exact.log_t_first, p.last = exact.log_t_last;
      }
      const PoleLine line(p.w0_ev / hartree_ev);
      for (int i = 0; i < most_draws; ++i) {
        const double u = line.square_of_momentum(p.first + random.uniform() * (p.last - p.first));
        const double w = line.loss_of_square(u), q = std::sqrt(u);
        if (!(u > 0) || !is_allowed(energy_ev, w, q)) continue;
        loss = {w, q, 0, line.is_collective(q, w)};
        if (p.w0_ev > shells_.lowest_ev()) loss.shell_ev = shells_.draw(p.w0_ev, w * hartree_ev, random.uniform());
        return true;
      }
    }
    return false;
  }

  std::size_t bytes() const override { return points_.size() * sizeof(Point); }

 private:
  struct Point {
    float w0_ev, log_t_first, log_t_last;
  };
  struct Place {
    double w0_ev, first, last;
  };

  Point point(double energy_ev, double w0_ev) const {
    // Quantiles at the very ends may lie where no momentum is allowed by a rounding.
    for (const double shrink : {1.0, 1 - 1e-9, 1 - 1e-6, 1 - 1e-4, 1 - 1e-2}) {
      const double w0 = w0_ev * shrink / hartree_ev;
      const SinglePole::Momenta m = pole_.momenta(energy_ev / hartree_ev, w0);
      if (!(m.last >= m.first)) continue;
      const PoleLine line(w0);
      return {static_cast<float>(w0_ev), static_cast<float>(line.log_t(m.first)), static_cast<float>(line.log_t(m.last))};
    }
    return {static_cast<float>(w0_ev), 0, 0};
  }

  bool is_allowed(double energy_ev, double w, double q) const {
    const double energy = energy_ev / hartree_ev;
    if (energy_ev - w * hartree_ev < pole_.limits().filled_ev + pole_.limits().gap_ev) return false;
    const double p = atomic::momentum(energy);
    return w * (1 + (energy - 0.5 * w) / atomic::rest_energy) + 0.5 * q * q <= p * q;
  }

  SinglePole pole_;
  Shells shells_;
  double least_ev_;
  int without_ = 0;             // edges of energy bins below all losses
  std::vector<Point> points_;   // [edge, from `without_`][quantile]
};

}  // namespace

std::unique_ptr<const LossSampler> make_single_pole_sampler(const DielectricData& data) {
  return std::make_unique<SinglePoleSampler>(data);
}

}  // namespace surf::mc
