// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/tables/cascade_tables.h"

#include <vector>

#include "tables/cascade_bins.h"

namespace surf::mc {
namespace {

struct Extent {
  CascadeBins bins;
  void segment(const CascadeSegment&) {}
  void stop(const Vec3& at, bool) { bins.add(at); }
};

/// Each point is shared between the two nearest heights: what is linear between them keeps its
/// centre.
struct Fill {
  StoppingPointParameters& table;
  double per_nm;
  void segment(const CascadeSegment&) {}
  void stop(const Vec3& at, bool primary) {
    std::vector<double>& density = table.channels[primary ? 1 : 0].density_per_nm;
    const double t = (at.z - table.lowest_nm) / table.height_step_nm;
    const auto i = static_cast<std::size_t>(t);
    const double u = t - static_cast<double>(i);
    double* place =
        density.data() + ring_of(table, at) * static_cast<std::size_t>(table.heights) + i;
    place[0] += (1 - u) * per_nm;
    place[1] += u * per_nm;
  }
};

/// Level ground gives the sum of what lies above 0, between heights in proportion.
void scale_to(double yield, StoppingPointParameters& table) {
  std::vector<double>& density = table.channels[0].density_per_nm;
  const auto ground = static_cast<std::size_t>(-table.lowest_nm / table.height_step_nm + 0.5);
  const auto heights = static_cast<std::size_t>(table.heights);
  double above = 0;
  for (std::size_t i = 0; i < density.size(); ++i)
    above += i % heights < ground
                 ? 0
                 : density[i] * table.height_step_nm * (i % heights == ground ? 0.5 : 1);
  for (double& d : density) d *= above > 0 ? yield / above : 1;
}

}  // namespace

StoppingPointParameters stopping_points(const CascadeLibrary& library,
                                        const CascadeTableOptions& options) {
  check_table(library, options);
  Extent extent;
  walk_all(library, extent);
  StoppingPointParameters table;
  extent.bins.lay_out(options, table);
  const std::vector<double> none(
      static_cast<std::size_t>(table.rings) * static_cast<std::size_t>(table.heights), 0.0);
  table.channels = {{"SE", StoppingRule::counted, none}, {"BSE", StoppingRule::reflected, none}};
  Fill fill{table, 1 / (static_cast<double>(library.cascades()) * table.height_step_nm)};
  walk_all(library, fill);
  if (options.flat_se_yield > 0) scale_to(options.flat_se_yield, table);
  return table;
}

}  // namespace surf::mc
