// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_parameters.h"

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/scan_parameters.h"

namespace surf::cli {

void describe(ParameterVisitor& visit, MeshParameters& p) {
  visit.form(
      {.name = "mesh.out_unit",
       .help = "Length of one unit of the output, in place of a magnification",
       .otherwise = "nm",
       .form = "nm|um|mm|m|pm|A|in"},
      [&] { return p.out_unit_nm ? format_exact(*p.out_unit_nm) + "nm" : std::string(); },
      [&](std::string_view text, const std::string& subject) {
        p.out_unit_nm = io::parse_unit_nm(text, subject);
      });
  visit(p.scale, {.name = "mesh.scale",
                  .help = "Factor of all coordinates",
                  .limits = above(0),
                  .form = "FACTOR"});
  visit(p.repair, {.name = "mesh.repair",
                   .help = "Merge, stitch, orient, fill holes, resolve self-intersections"});
  describe(visit, p.mending);
  visit(p.smooth, {.name = "mesh.smooth",
                   .help = "Number of rounds of Taubin smoothing",
                   .limits = within(1, 100'000),
                   .otherwise = "none"});
  describe(visit, p.reduce);
  visit(p.solid, {.name = "mesh.solid", .help = "Close an open sheet by walls and a base"});
  visit(p.thickness_nm, {.name = "mesh.thickness",
                         .help = "Thickness of the base under the lowest place",
                         .unit = Unit::nm,
                         .limits = above(0),
                         .otherwise = "5 % of the longer side"});
  visit(p.plain, {.name = "mesh.plain", .help = "Leave out height and curvature as scalars"});
  visit(p.magnification, {.name = "mesh.magnification",
                          .help = "Magnification of glTF, 3MF, STL and OBJ",
                          .limits = above(0),
                          .otherwise = "1e6: 1 nm is 1 mm",
                          .form = "FACTOR"});
  visit(p.true_size, {.name = "mesh.true_size", .help = "Magnification 1"});
  visit(p.z_exaggeration, {.name = "mesh.z_exaggeration",
                           .help = "Factor of heights besides the magnification, in these formats",
                           .limits = above(0),
                           .otherwise = "1",
                           .form = "FACTOR"});
}

io::MeshUnit mesh_unit_of(const io::SpecimenRequest& request) {
  if (request.override_unit && !request.mesh_unit_nm)
    throw UsageError("--override-unit", "there is no unit to take in place of the file's",
                     "Add --unit um, or leave it out");
  if (!request.mesh_unit_nm) return {};
  return {request.mesh_unit_nm, request.override_unit};
}

}  // namespace surf::cli
