// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/full_penn_table.h"
#include "physics/dielectric/loss_quantiles.h"
#include "physics/dielectric/loss_sampler.h"
#include "surf/mc/physics/full_penn.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {
namespace {

using atomic::hartree_ev;

constexpr int cells = 384;  // of a loss's momenta

// Most of a loss's momenta are the smallest, which fast electrons alone can hand over. What slow
// electrons hand over lies among the largest: cells shrink towards them.
double rest_below(int cell) {  // the part of momenta that are larger than those below a cell
  const double r = 1 - double(cell) / cells;
  return r * r * r * r;
}
double place_of(double rest) { return (1 - std::sqrt(std::sqrt(rest))) * cells; }

constexpr int most_redraws = 1000;

class FullPennSampler final : public LossSampler {
 public:
  explicit FullPennSampler(const DielectricData& data)
      : penn_(data), band_(data.band), shells_(data),
        losses_(data.band, penn_.table().losses.front() * hartree_ev) {
    make_guide();
    invert_rows();
    for (int i = 0; i <= EnergyBins::count; ++i)
      rates_per_nm_.push_back(losses_.add(EnergyBins::lower_ev(i), *this) / atomic::bohr_nm);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    const int bin = EnergyBins::bin(energy_ev);
    const double from = EnergyBins::lower_ev(bin), to = EnergyBins::lower_ev(bin + 1);
    const double share = std::clamp((energy_ev - from) / (to - from), 0.0, 1.0);
    const auto i = static_cast<std::size_t>(bin);
    return rates_per_nm_[i] + share * (rates_per_nm_[i + 1] - rates_per_nm_[i]);
  }

  double stopping_power_ev_per_nm(double energy_ev) const override {
    return penn_.stopping_power_ev_per_nm(energy_ev);
  }

  bool draw(double energy_ev, RandomStream& random, Loss& loss) const override {
    if (!losses_.can_lose(energy_ev)) return false;
    const double energy = energy_ev / hartree_ev, before = atomic::momentum(energy);
    for (int redraws = 0; redraws < most_redraws; ++redraws) {
      const LossQuantiles::Place p = losses_.draw(energy_ev, random, *this);
      const double w = p.loss_ev / hartree_ev;
      if (!(energy_ev - p.loss_ev >= band_.free_ev())) continue;
      const Row row = row_of(p.loss_ev);
      const double c = place_of(p.first + random.uniform() * (p.last - p.first));
      const int k = std::clamp(static_cast<int>(c), 0, cells - 1);
      const double f = c - k;
      const Cell* const a = &cells_[row.number * (cells + 1) + static_cast<std::size_t>(k)];
      const Cell* const b = a + (cells + 1);
      const double lower = a[0].log_x + f * (a[1].log_x - a[0].log_x),
                   upper = b[0].log_x + f * (b[1].log_x - b[0].log_x);
      const double q = std::exp(lower + row.share * (upper - lower)) * std::sqrt(2 * w);
      const double after = atomic::momentum(energy - w);
      if (!(q >= before - after && q <= before + after)) continue;
      const double kind = random.uniform();
      const auto mix = [&](float x, float y) { return x + row.share * (y - x); };
      const double inner = mix(a->inner, b->inner);
      loss = {w, q, 0, false};
      if (kind < inner) loss.shell_ev = shells_.draw_inner(p.loss_ev, kind / inner);
      else loss.collective = kind < inner + mix(a->plasmon, b->plasmon) * (1 - inner);
      return true;
    }
    return false;
  }

  std::size_t bytes() const override {
    return losses_.bytes() + cells_.size() * sizeof(Cell) + penn_.table().bytes();
  }

  // What LossQuantiles asks.
  void integrate(double energy_ev, double most_ev, std::vector<double>& edges,
                 std::vector<double>& sums) const {
    const FullPenn::Table& t = penn_.table();
    for (std::size_t row = 0; row < t.rows(); ++row) {
      const double half = 0.5 * t.widths[row];
      const double from = std::max(edges.back(), row_ev_[row] * std::exp(-half)),
                   to = std::min(most_ev, row_ev_[row] * std::exp(half));
      if (!(to > from)) continue;
      sums.push_back(sums.back() + std::log(to / from) * t.density(energy_ev / hartree_ev, row));
      edges.push_back(to);
    }
  }

  // Momenta as the part of the loss's momenta that are larger.
  LossAndRange range(double energy_ev, double w_ev) const {
    const double energy = energy_ev / hartree_ev,
                 w = std::min(w_ev, energy_ev - band_.free_ev()) / hartree_ev;
    const double p = atomic::momentum(energy), after = atomic::momentum(energy - w),
                 unit = std::sqrt(2 * w);
    const Row row = row_of(w_ev);
    const auto part = [&](double q) {
      const double lower = part_above(row.number, q / unit),
                   upper = part_above(row.number + 1, q / unit);
      return static_cast<float>(lower + row.share * (upper - lower));
    };
    return LossAndRange{static_cast<float>(w_ev), part(p - after), part(p + after)};
  }

 private:
  struct Cell {
    float log_x;           // at its lower edge
    float plasmon, inner;  // shares in it
  };
  struct Row {
    std::size_t number;
    double share;  // towards the next
  };

  // The row at or below a loss, of those that have one above.
  Row row_of(double w_ev) const {
    std::size_t i = guide_[Guide::bin(w_ev)];
    while (i + 2 < row_ev_.size() && row_ev_[i + 1] <= w_ev) ++i;
    return {i, std::clamp((w_ev - row_ev_[i]) / (row_ev_[i + 1] - row_ev_[i]), 0.0, 1.0)};
  }

  // The row at or below the lower edge of each of many bins of losses.
  struct Guide {
    static constexpr int bits = 6;  // of the mantissa
    static constexpr double lowest_ev = 1.0 / 128;
    static std::size_t bin(double w_ev) {
      constexpr int shift = 52 - bits;
      constexpr auto base = std::bit_cast<std::uint64_t>(lowest_ev) >> shift;
      const auto i = std::bit_cast<std::uint64_t>(std::max(w_ev, lowest_ev)) >> shift;
      return std::min<std::size_t>(i - base, bins - 1);
    }
    static double lower_ev(std::size_t bin) {
      constexpr int shift = 52 - bits;
      return std::bit_cast<double>(((std::bit_cast<std::uint64_t>(lowest_ev) >> shift) + bin)
                                   << shift);
    }
    static constexpr std::size_t bins = 23 << bits;
  };

  void make_guide() {
    for (const double w : penn_.table().losses) row_ev_.push_back(w * hartree_ev);
    guide_.resize(Guide::bins);
    std::size_t row = 0;
    for (std::size_t i = 0; i < guide_.size(); ++i) {
      while (row + 2 < row_ev_.size() && row_ev_[row + 1] <= Guide::lower_ev(i)) ++row;
      guide_[i] = row;
    }
  }

  // The part of a row's momenta above one.
  double part_above(std::size_t row, double x) const {
    const FullPenn::Table& t = penn_.table();
    const double whole = t.integral[(row + 1) * t.edges.size() - 1];
    return whole > 0 ? std::clamp((whole - t.up_to(row, x * std::sqrt(2 * t.losses[row]))) / whole,
                                  0.0, 1.0)
                     : 1;
  }

  void invert_rows() {
    const FullPenn::Table& t = penn_.table();
    cells_.resize(t.rows() * (cells + 1));
    for (std::size_t row = 0; row < t.rows(); ++row) {
      const float* const sums = &t.integral[row * t.edges.size()];
      const double whole = sums[t.cells()];
      std::size_t k = 0;
      for (int i = 0; i <= cells; ++i) {
        const double wanted = whole * (1 - rest_below(i));
        while (k + 1 < t.cells() && sums[k + 1] <= wanted && (sums[k + 1] < whole)) ++k;
        while (i == 0 && k + 1 < t.cells() && !(sums[k + 1] > 0)) ++k;
        const double width = sums[k + 1] - sums[k],
                     f = width > 0 ? std::clamp((wanted - sums[k]) / width, 0.0, 1.0) : 0;
        const double low = std::log(t.edges[k]), high = std::log(t.edges[k + 1]);
        // The kind is that of the cell's middle.
        std::size_t m = k;
        const double middle =
            whole * (1 - 0.5 * (rest_below(i) + rest_below(std::min(i + 1, cells))));
        while (m + 1 < t.cells() && sums[m + 1] <= middle) ++m;
        cells_[row * (cells + 1) + static_cast<std::size_t>(i)] = {
            static_cast<float>(low + f * (high - low)), t.plasmon[row * t.cells() + m],
            t.inner[row * t.cells() + m]};
      }
    }
  }

  FullPenn penn_;
  BandLimits band_;
  Shells shells_;
  LossQuantiles losses_;
  std::vector<double> row_ev_;  // losses of rows
  std::vector<std::size_t> guide_;
  std::vector<double> rates_per_nm_;  // 1 / lambda at the edges of energy bins
  std::vector<Cell> cells_;           // [row][cell]
};

}  // namespace

std::unique_ptr<const LossSampler> make_full_penn_sampler(const DielectricData& data) {
  return std::make_unique<FullPennSampler>(data);
}

}  // namespace surf::mc
