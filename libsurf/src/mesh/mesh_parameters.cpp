// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "surf/core/parameters.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/simplify_mesh.h"

namespace surf {

void describe(ParameterVisitor& visit, RepairOptions& o) {
  visit(o.stitch_nm, {.name = "mesh.stitch",
                      .help = "Distance of rims that are joined",
                      .unit = Unit::nm,
                      .limits = at_least(0),
                      .otherwise = "1e-6 of the diagonal"});
  visit(o.sliver_nm, {.name = "mesh.sliver",
                      .help = "Height of triangles that are removed as too flat",
                      .unit = Unit::nm,
                      .limits = at_least(0)});
  visit(o.max_hole_nm, {.name = "mesh.max_hole",
                        .help = "Longest rim of a hole to fill",
                        .unit = Unit::nm,
                        .limits = at_least(0),
                        .otherwise = "the diagonal of its component"});
  visit(o.min_component_nm, {.name = "mesh.min_component",
                             .help = "Size below which separate parts are dropped",
                             .unit = Unit::nm,
                             .limits = at_least(0)});
  bool keep = !o.resolve_self_intersections;
  visit(keep, {.name = "mesh.keep_intersections",
               .help = "Count self-intersections, but leave them as they are"});
  o.resolve_self_intersections = !keep;
}

void describe(ParameterVisitor& visit, SimplifyOptions& o) {
  std::optional<double> tolerance_nm =
      o.tolerance_nm > 0 ? std::optional(o.tolerance_nm) : std::nullopt;
  visit(tolerance_nm,
        {.name = "mesh.mesh_tolerance",
         .help = "Simplify to fewer triangles, moving the surface nowhere by more than this",
         .unit = Unit::nm,
         .limits = above(0),
         .otherwise = "all"});
  o.tolerance_nm = tolerance_nm.value_or(0);
  std::optional<std::int64_t> triangles =
      o.triangles > 0 ? std::optional(static_cast<std::int64_t>(o.triangles)) : std::nullopt;
  visit(triangles, {.name = "mesh.triangles",
                    .help = "Simplify to this many triangles",
                    .limits = within(4, 1e9),
                    .otherwise = "all"});
  o.triangles = static_cast<std::size_t>(triangles.value_or(0));
}

}  // namespace surf
