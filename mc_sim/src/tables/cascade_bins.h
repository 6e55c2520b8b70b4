// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cascades/walk_cascade.h"
#include "surf/core/error.h"
#include "surf/mc/tables/cascade_tables.h"

namespace surf::mc {

/// Rings and heights that hold what is told of to `add`.
class CascadeBins {
 public:
  void add(const Vec3& p) {
    radius_ = std::max(radius_, std::hypot(p.x, p.y));
    low_ = std::min(low_, p.z), high_ = std::max(high_, p.z);
  }

  /// Sets the table's layout: the entry is at one of the heights, and beyond the lowest and the
  /// highest thing there is one height more at least.
  template <class Parameters>
  void lay_out(const CascadeTableOptions& options, Parameters& out) const {
    out.rings = options.rings;
    out.ring_nm = radius_ > 0 ? radius_ / options.rings * (1 + 1e-9) : 1;
    out.height_step_nm = high_ > low_ ? (high_ - low_) / options.heights : 1;
    const double first = std::floor(low_ / out.height_step_nm) - 1,
                 last = std::floor(high_ / out.height_step_nm) + 2;
    out.lowest_nm = first * out.height_step_nm;
    out.heights = static_cast<int>(last - first) + 1;
  }

 private:
  double radius_ = 0, low_ = 0, high_ = 0;
};

/// The ring of a place.
template <class Parameters>
std::size_t ring_of(const Parameters& p, const Vec3& at) {
  return static_cast<std::size_t>(
      std::clamp(static_cast<int>(std::hypot(at.x, at.y) / p.ring_nm), 0, p.rings - 1));
}

inline void check_table(const CascadeLibrary& library, const CascadeTableOptions& options) {
  if (options.rings < 1 || options.rings > 1024 || options.heights < 2 || options.heights > 1024)
    throw UsageError("cascade table",
                     fmt::format("{} rings of {} heights", options.rings, options.heights),
                     "Give 1 to 1024 rings and 2 to 1024 heights");
  if (!(std::isfinite(options.flat_se_yield) && options.flat_se_yield >= 0))
    throw UsageError("cascade table", "the yield of level ground is below 0 or not finite",
                     "Give 0 or above");
  if (library.cascades() == 0)
    throw InvalidInput("cascade table", "the library is empty", "Let it grow first");
}

/// Tells the visitor of all cascades.
template <class Visitor>
void walk_all(const CascadeLibrary& library, Visitor& visitor) {
  const EnergyCode code(library.medium().cutoff_ev(), library.settings().start_energy_ev);
  CascadeWalk<Visitor> walk(code, visitor);
  for (std::size_t i = 0; i < library.cascades(); ++i) walk.walk(library.cascade(i).data());
}

}  // namespace surf::mc
