// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/tier_doubt.h"

#include <fmt/format.h>

#include "surf/core/units.h"

namespace surf::workflow {
namespace {

// Differences relative to the image's mean, from bench_tiers.
constexpr double of_topography = 0.02, of_edges = 0.08, of_materials = 0.3;

}  // namespace

std::optional<std::string> tier_doubt(const mc::Physics& physics, std::size_t materials,
                                      double accuracy) {
  if (mc::is_dielectric(physics)) return std::nullopt;
  const std::string asked = format_share(accuracy),
                    better = "more than the " + asked +
                             " asked for; inelastic=dielectric is more certain";
  if (materials > 1 && accuracy < of_materials)
    return fmt::format("monsel: contrast between materials may be {} off, {}",
                       format_share(of_materials), better);
  if (accuracy < of_topography)
    return fmt::format(
        "monsel: topography differs by {} beyond a common factor, and by {} at steep edges, {}",
        format_share(of_topography), format_share(of_edges), better);
  if (accuracy < of_edges)
    return fmt::format(
        "monsel: accurate enough for topography ({} off beyond a common factor); at steep edges {} "
        "off, {}",
        format_share(of_topography), format_share(of_edges), better);
  return fmt::format("monsel: accurate enough for {}, apart from a common factor", asked);
}

}  // namespace surf::workflow
