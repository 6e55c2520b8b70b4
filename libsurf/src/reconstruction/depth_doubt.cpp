// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth_doubt.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gaussian_basis.h"

namespace surf::reconstruction {
namespace {

constexpr double touched_px = 3;    // contacts lie closer than this where the tip reached
constexpr double least_gap_px = 2;  // a chance gap between contacts hides no depth
constexpr int gap_px = 6;           // half of what counts as one narrow place
constexpr double soft_px = 1;
constexpr double around_px = 2;       // range over which the signal is averaged
constexpr double model_error = 0.08;  // of the signal in narrow places, where shadows meet edges
constexpr double steps_nm[] = {2, 4, 8, 16, 32, 64, 128};

/// Distances to the nearest contact, in samples, as far as `gap_px` beyond `touched_px`.
Grid<double> distances(const std::vector<Contact>& contacts, int width, int height) {
  constexpr int reach = static_cast<int>(touched_px) + gap_px + 1;
  Grid<double> out(width, height, reach);
  for (const Contact& c : contacts) {
    if (!c.inside) continue;
    const int column = static_cast<int>(c.x + 0.5), row = static_cast<int>(c.y + 0.5);
    for (int y = std::max(0, row - reach); y <= std::min(height - 1, row + reach); ++y)
      for (int x = std::max(0, column - reach); x <= std::min(width - 1, column + reach); ++x)
        out(x, y) = std::min(out(x, y), std::hypot(x - c.x, y - c.y));
  }
  return out;
}

/// From 0 at the rim of a place without contacts to 1 in its middle.
Grid<double> depth_within(const Grid<double>& distance) {
  const int w = distance.width(), h = distance.height();
  Grid<double> beyond = distance, out(w, h);
  for (double& d : beyond.data()) d = std::max(0.0, d - touched_px);
  const auto widest = [](const Grid<double>& from, bool along_x) {
    Grid<double> to = from;
    for (int y = 0; y < from.height(); ++y)
      for (int x = 0; x < from.width(); ++x)
        for (int k = -gap_px; k <= gap_px; ++k) {
          const int u = along_x ? std::clamp(x + k, 0, from.width() - 1) : x,
                    v = along_x ? y : std::clamp(y + k, 0, from.height() - 1);
          to(x, y) = std::max(to(x, y), from(u, v));
        }
    return to;
  };
  const Grid<double> most = widest(widest(beyond, true), false);
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] = beyond.data()[i] / std::max(most.data()[i], least_gap_px);
  return out;
}

}  // namespace

Grid<double> depth_doubt(const Objective& o, const Unknowns& at, const Objective::State& state,
                         int threads) {
  const int w = at.z_nm.width(), h = at.z_nm.height();
  Grid<double> doubt(w, h);
  if (!o.afm || !o.sem) return doubt;
  const Grid<double> shape = depth_within(distances(state.afm->contacts, w, h));
  const double lowest = *std::ranges::min_element(at.z_nm.data());
  const GaussianBasis around(around_px, threads);
  constexpr double pixels = 4 * std::numbers::pi * around_px * around_px;
  const Grid<double> before = around.sum(state.sem->simulated);
  Mask objects(w, h);
  for (const double step : steps_nm) {
    Grid<double> lower = at.z_nm;
    for (std::size_t i = 0; i < lower.size(); ++i)
      lower.data()[i] = std::max(lowest, lower.data()[i] - step * shape.data()[i]);
    const Grid<double> now = around.sum(o.sem->evaluate(lower, at.mixture).simulated);
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (objects.data()[i] || shape.data()[i] == 0) continue;
      const double changed = now.data()[i] - before.data()[i],
                   may_be_off = model_error * (before.data()[i] - at.mixture.offset);
      const double deviations =
          std::abs(changed) /
          std::sqrt(may_be_off * may_be_off + o.sem->noise().variance(before.data()[i]) / pixels);
      const double here = at.z_nm.data()[i] - lower.data()[i];
      objects.data()[i] = deviations > 1;
      doubt.data()[i] = std::max(doubt.data()[i], here / std::max(1.0, deviations));
    }
  }
  for (double& d : doubt.data()) d *= d;
  doubt = GaussianBasis(soft_px, threads).sum(doubt);
  for (double& d : doubt.data()) d = std::sqrt(std::max(d, 0.0));
  return doubt;
}

}  // namespace surf::reconstruction
