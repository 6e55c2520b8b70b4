// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/full_penn.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/full_penn_table.h"
#include "physics/dielectric/lindhard.h"
#include "surf/core/parallel.h"

namespace surf::mc {
namespace {

using atomic::bohr_nm;
using atomic::hartree_ev;

constexpr double first_loss_ev = 0.02, last_loss_ev = 3e4;
constexpr double last_plasma_ev = 3e4;
constexpr double optical = 0.02;  // of x and of q: below, the function is that of light
constexpr int most_points = 96;   // of an integral over plasma energies

// Logarithmic, finer where the functions of solids have their peaks.
std::vector<double> loss_edges(double least_ev) {
  std::vector<double> edges{least_ev};
  while (edges.back() < last_loss_ev) {
    const double w = edges.back();
    edges.push_back(w * std::pow(10.0, 1.0 / (w < 1 ? 60 : w < 100 ? 200 : 64)));
  }
  return edges;
}

std::vector<double> momentum_edges() {
  std::vector<double> edges{1e-4};
  while (edges.back() < 100) {
    const double x = edges.back();
    edges.push_back(x * std::pow(10.0, 1.0 / (x < 0.1 ? 24 : x < 3 ? 160 : 32)));
  }
  return edges;
}

double weight(const EnergyLossFunction& elf, double plasma) {
  return 2 / (std::numbers::pi * plasma) * elf(plasma * hartree_ev);
}

}  // namespace

FullPenn::Parts FullPenn::Table::value(double w, double q) const {
  const double w_ev = w * hartree_ev;
  Parts parts;
  const auto inner_share = [&](double plasma) {
    return plasma * hartree_ev > shells.lowest_ev() ? shells.share(plasma * hartree_ev, w_ev) : 0;
  };
  if (q < optical && q < optical * std::sqrt(2 * w)) {
    parts.plasmon = elf(w_ev);
    parts.inner = parts.plasmon * inner_share(w);
    return parts;
  }
  // The gas on whose continuum's edge (q, w) lies: denser ones have pairs there; of thinner ones,
  // the plasmon may.
  const double edge = std::fabs(w - 0.5 * q * q) / q;
  const double least = Lindhard::plasma_energy(edge);
  if (w > 0.5 * q * q) {
    double low = 0.2 * w, high = std::min(least, w);
    const auto real = [&](double plasma) { return Lindhard::of_plasma_energy(plasma).real(q, w); };
    if (real(high * (1 - 1e-12)) < 0) {
      while (low > 1e-6 && real(low) < 0) low *= 0.5;
      for (int i = 0; i < 60 && high - low > 1e-12 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (real(middle) > 0 ? low : high) = middle;
      }
      const double plasma = 0.5 * (low + high), step = 1e-4 * plasma;
      const double slope =
          (real(plasma) - real(plasma - step)) / step;  // from below: above may be the continuum
      parts.plasmon = weight(elf, plasma) * std::numbers::pi / std::fabs(slope);
      parts.inner += parts.plasmon * inner_share(plasma);
    }
  }
  // From the edge on, where the function rises steeply, in steps that grow.
  const double from = std::max({least, data.band.gap_ev / hartree_ev, 1e-4});
  const double log_from = std::log(from), whole = std::log(last_plasma_ev / hartree_ev) - log_from;
  if (!(whole > 0)) return parts;
  for (int i = 0; i < most_points; ++i) {
    const double y = (i + 0.5) / most_points, log_plasma = log_from + y * y * whole;
    const double place = (log_plasma - first_log) / step_log;
    const auto k =
        static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(weights.size() - 2)));
    const double g = weights[k] + (place - static_cast<double>(k)) * (weights[k + 1] - weights[k]);
    if (!(g > 0)) continue;
    const Lindhard gas = Lindhard::of_log_plasma_energy(log_plasma);
    const double b = gas.imaginary(q, w);
    if (!(b > 0)) continue;
    const double a = gas.real(q, w);
    const double part = g * b / (a * a + b * b) * whole * 2 * y / most_points;
    parts.pairs += part;
    if (w_ev > shells.lowest_ev()) parts.inner += part * inner_share(std::exp(log_plasma));
  }
  return parts;
}

FullPenn::Table::Table(const DielectricData& d)
    : data(d), elf(d.band.gap_ev > 0 ? d.elf.above(d.band.gap_ev) : d.elf), shells(d),
      edges(momentum_edges()) {
  first_log = std::log(1e-4), step_log = 1.0 / 256;
  for (double at = first_log; at < std::log(last_plasma_ev / hartree_ev) + 2 * step_log;
       at += step_log)
    weights.push_back(static_cast<float>(weight(elf, std::exp(at)) * std::exp(at)));
  const std::vector<double> bounds = loss_edges(std::max(first_loss_ev, d.band.gap_ev));
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    losses.push_back(std::sqrt(bounds[i] * bounds[i + 1]) / hartree_ev);
    widths.push_back(std::log(bounds[i + 1] / bounds[i]));
  }
  integral.assign(rows() * edges.size(), 0);
  plasmon.assign(rows() * cells(), 0);
  inner.assign(rows() * cells(), 0);
  parallel_for(rows(), 0, [&](std::size_t i, int) {
    const double w = losses[i], unit = std::sqrt(2 * w);
    double sum = 0;
    for (std::size_t k = 0; k < cells(); ++k) {
      const Parts p = value(w, unit * std::sqrt(edges[k] * edges[k + 1]));
      const double whole = p.plasmon + p.pairs;
      sum += whole * std::log(edges[k + 1] / edges[k]);
      integral[i * edges.size() + k + 1] = static_cast<float>(sum);
      plasmon[i * cells() + k] = whole > 0 ? static_cast<float>(p.plasmon / whole) : 0;
      inner[i * cells() + k] = whole > 0 ? static_cast<float>(p.inner / whole) : 0;
    }
  });
}

double FullPenn::Table::up_to(std::size_t row, double momentum) const {
  const double x = momentum / std::sqrt(2 * losses[row]);
  const float* const sums = &integral[row * edges.size()];
  if (x <= edges.front()) return elf(losses[row] * hartree_ev) * std::log(x / edges.front());
  if (x >= edges.back()) return sums[cells()];
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(edges, x) - edges.begin());
  const double share = std::log(x / edges[above - 1]) / std::log(edges[above] / edges[above - 1]);
  return sums[above - 1] + share * (sums[above] - sums[above - 1]);
}

double FullPenn::Table::density(double energy, std::size_t row) const {
  const double w = losses[row];
  const double p = atomic::momentum(energy), after = atomic::momentum(energy - w);
  const double whole = up_to(row, p + after) - up_to(row, p - after);
  return std::max(0.0, whole) * w / (std::numbers::pi * atomic::half_squared_speed(energy));
}

FullPenn::FullPenn(const DielectricData& data) : table_(std::make_shared<const Table>(data)) {}

FullPenn::Parts FullPenn::value(double loss, double momentum) const {
  return table_->value(loss, momentum);
}

double FullPenn::between_per_nm(double energy_ev, double from_ev, double to_ev) const {
  const Table& t = *table_;
  const double energy = energy_ev / hartree_ev;
  const double most = std::min(to_ev, energy_ev - t.data.band.free_ev()) / hartree_ev,
               least = from_ev / hartree_ev;
  double sum = 0;
  for (std::size_t i = 0; i < t.rows(); ++i) {
    const double half = 0.5 * t.widths[i], low = std::max(least, t.losses[i] * std::exp(-half));
    const double high = std::min(most, t.losses[i] * std::exp(half));
    if (high > low) sum += std::log(high / low) * t.density(energy, i);
  }
  return sum / bohr_nm;
}

double FullPenn::inverse_mean_free_path_per_nm(double energy_ev) const {
  return between_per_nm(energy_ev, 0, energy_ev);
}

double FullPenn::stopping_power_ev_per_nm(double energy_ev) const {
  const Table& t = *table_;
  const double energy = energy_ev / hartree_ev, most = energy - t.data.band.free_ev() / hartree_ev;
  double sum = 0;
  for (std::size_t i = 0; i < t.rows(); ++i) {
    const double half = 0.5 * t.widths[i], low = t.losses[i] * std::exp(-half),
                 high = std::min(most, t.losses[i] * std::exp(half));
    if (!(high > low)) break;
    const double w = std::sqrt(low * high);
    sum += std::log(high / low) * std::min(w, most - w) * t.density(energy, i);
  }
  return sum * hartree_ev / bohr_nm;
}

}  // namespace surf::mc
