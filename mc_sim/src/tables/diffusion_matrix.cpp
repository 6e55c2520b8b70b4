// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/tables/cascade_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "surf/mc/physics/barrier.h"
#include "tables/cascade_bins.h"

namespace surf::mc {
namespace {

/// Probability to get out, averaged over directions of Lambert's law: integral of 2 c T(E c^2) over
/// the cosine c from 0 to 1. Tabled evenly in the logarithm of the energy.
class Escape {
 public:
  Escape(BarrierModel model, double barrier_ev, double top_ev) : barrier_ev_(barrier_ev) {
    if (model == BarrierModel::off || barrier_ev <= 0) return;
    per_log_ = steps / std::log(top_ev / barrier_ev);
    for (int i = 0; i <= steps; ++i) {
      const double energy = barrier_ev * std::exp(i / per_log_);
      double sum = 0;
      constexpr int cosines = 400;
      for (int j = 0; j < cosines; ++j) {
        const double c = (j + 0.5) / cosines;
        sum += 2 * c * transmission(model, energy * c * c, barrier_ev) / cosines;
      }
      table_.push_back(sum);
    }
  }

  double operator()(double energy_ev) const {
    if (table_.empty()) return 1;
    const double t = std::log(energy_ev / barrier_ev_) * per_log_;
    if (!(t > 0)) return 0;
    const int i = std::min(static_cast<int>(t), steps - 1);
    const double u = std::min(t - i, 1.0);
    return (1 - u) * table_[static_cast<std::size_t>(i)] +
           u * table_[static_cast<std::size_t>(i) + 1];
  }

 private:
  static constexpr int steps = 512;
  double barrier_ev_, per_log_ = 0;
  std::vector<double> table_;
};

bool counts(const CascadeSegment& s) { return !(s.primary && s.first); }

struct Extent {
  CascadeBins bins;
  void segment(const CascadeSegment& s) {
    if (counts(s)) bins.add(s.from), bins.add(s.to);
  }
  void stop(const Vec3&, bool) {}
};

/// Path lengths times directions, in pieces shorter than the bins.
struct Fill {
  DiffusionMatrixParameters& table;
  const Escape& escape;
  double split_ev;  // from the bottom of the band

  void segment(const CascadeSegment& s) {
    const Vec3 way = s.to - s.from;
    const double path = length(way);
    if (!counts(s) || path <= 0) return;
    const Vec3 v = way * (1 / path);
    const int pieces =
        1 + static_cast<int>(2 * path / std::min(table.ring_nm, table.height_step_nm));
    for (int i = 0; i < pieces; ++i) {
      const double t = (i + 0.5) / pieces,
                   energy = s.energy_from_ev + t * (s.energy_to_ev - s.energy_from_ev);
      add(s.from + way * t, v, path / pieces * escape(energy), energy >= split_ev ? 1 : 0);
    }
  }
  void stop(const Vec3&, bool) {}

 private:
  void add(const Vec3& at, const Vec3& v, double weight, std::size_t channel) {
    const double r = std::hypot(at.x, at.y), c = r > 0 ? at.x / r : 1, s = r > 0 ? at.y / r : 0;
    const double outward = v.x * c + v.y * s, around = v.y * c - v.x * s;
    const auto height =
        static_cast<std::size_t>((at.z - table.lowest_nm) / table.height_step_nm + 0.5);
    double* m =
        table.channels[channel].moments_per_nm2.data() +
        (ring_of(table, at) * static_cast<std::size_t>(table.heights) + height) * diffusion_moments;
    m[0] += weight * outward;
    m[1] += weight * v.z;
    m[2] += weight * outward * outward;
    m[3] += weight * around * around;
    m[4] += weight * v.z * v.z;
    m[5] += weight * outward * v.z;
  }
};

}  // namespace

DiffusionMatrixParameters diffusion_matrix(const CascadeLibrary& library,
                                           const CascadeTableOptions& options) {
  check_table(library, options);
  const double barrier_ev = library.medium().barrier_ev(),
               top_ev = library.settings().start_energy_ev;
  Extent extent;
  walk_all(library, extent);
  DiffusionMatrixParameters table;
  extent.bins.lay_out(options, table);
  const std::size_t bins =
      static_cast<std::size_t>(table.rings) * static_cast<std::size_t>(table.heights);
  const std::vector<double> none(bins * diffusion_moments, 0.0);
  table.channels = {{"SE", none}, {"BSE", none}};
  const Escape escape(library.settings().physics.barrier, barrier_ev,
                      std::max(top_ev, 2 * barrier_ev));
  Fill fill{table, escape, barrier_ev + se_bse_split_ev};
  walk_all(library, fill);
  for (DiffusionMatrixChannel& c : table.channels)
    for (int k = 0; k < table.rings; ++k) {
      const double area = std::numbers::pi * (2 * k + 1) * table.ring_nm * table.ring_nm;
      const double factor =
          1 / (static_cast<double>(library.cascades()) * area * table.height_step_nm);
      const auto row = static_cast<std::size_t>(table.heights) * diffusion_moments;
      for (std::size_t i = 0; i < row; ++i)
        c.moments_per_nm2[static_cast<std::size_t>(k) * row + i] *= factor;
    }
  return table;
}

}  // namespace surf::mc
