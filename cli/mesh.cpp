// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "commands.h"
#include "common_options.h"
#include "info.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/smooth_mesh.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(What is asked for happens in this order: unit, scale, repair, smooth, simplify, out-unit.
Nothing of it: the mesh is converted. 'semsurf info' says what is wrong with a mesh.

Examples:
  semsurf mesh part.stl --unit um -o part.ply
  semsurf mesh broken.obj --repair --max-hole 200nm -o sound.stl
  semsurf mesh scan.ply --simplify 1nm -o small.ply
  semsurf mesh scan.ply --smooth 20 --triangles 50000 --out-unit um -o model.obj)";

struct Options {
  std::string input;
  std::optional<std::string> output, unit, out_unit, scale, smooth, simplify, triangles;
  std::optional<std::string> stitch, sliver, max_hole, min_component;
  bool repair = false, keep_intersections = false, quiet = false;
};

double parse_factor(const std::string& text, const char* subject) {
  const double factor = parse_length_nm(text, subject);   // a bare number
  if (factor > 0 && text.find_first_not_of("0123456789.eE+-") == std::string::npos) return factor;
  throw UsageError(subject, fmt::format("'{}' is not a factor", text), "Give a number above 0");
}

double parse_distance(const std::string& text, const char* subject, bool zero_too) {
  const double nm = parse_length_nm(text, subject);
  if (nm > 0 || (zero_too && nm == 0)) return nm;
  throw UsageError(subject, fmt::format("'{}' is not above 0", text), "Give a length, as 1nm");
}

/// All the numbers, before a large mesh is read.
struct Plan {
  std::optional<double> unit_nm;
  double out_unit_nm = 1, scale = 1;
  RepairOptions repair;
  SmoothOptions smooth;
  SimplifyOptions simplify;
};

Plan make_plan(const Options& o) {
  if (o.input.empty()) throw UsageError("mesh", "no mesh is given", "Name a file to read");
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o mesh.ply");
  io::check_mesh_target(*o.output);
  Plan p;
  if (o.unit) p.unit_nm = parse_unit_nm(*o.unit, "--unit");
  if (o.out_unit) p.out_unit_nm = parse_unit_nm(*o.out_unit, "--out-unit");
  if (o.scale) p.scale = parse_factor(*o.scale, "--scale");
  if (o.stitch) p.repair.stitch_nm = parse_distance(*o.stitch, "--stitch", true);
  if (o.sliver) p.repair.sliver_nm = parse_distance(*o.sliver, "--sliver", true);
  if (o.max_hole) p.repair.max_hole_nm = parse_distance(*o.max_hole, "--max-hole", true);
  if (o.min_component) {
    p.repair.min_component_nm = parse_distance(*o.min_component, "--min-component", true);
  }
  p.repair.resolve_self_intersections = !o.keep_intersections;
  p.smooth.iterations =
      o.smooth ? static_cast<int>(parse_whole(*o.smooth, "--smooth", 1, 100000)) : 0;
  if (o.simplify) p.simplify.tolerance_nm = parse_distance(*o.simplify, "--simplify", false);
  if (o.triangles) {
    p.simplify.triangles =
        static_cast<std::size_t>(parse_whole(*o.triangles, "--triangles", 4, 1'000'000'000));
  }
  const bool for_repair = o.stitch || o.sliver || o.max_hole || o.min_component || o.keep_intersections;
  if (for_repair && !o.repair) {
    throw UsageError(o.max_hole ? "--max-hole" : o.stitch ? "--stitch" : o.sliver ? "--sliver"
                     : o.min_component ? "--min-component" : "--keep-intersections",
                     "it is about repairs, and there are none", "Add --repair");
  }
  return p;
}

void print_repair(const RepairSummary& summary) {
  const char* label = "repair";
  for (const std::string& line : describe(summary)) {
    fmt::print("{:<10} {}\n", label, line);
    label = "";
  }
}

void advise(const RepairSummary& summary) {
  double longest_nm = 0;
  for (const OpenHole& hole : summary.open_holes) {
    if (hole.too_large) longest_nm = std::max(longest_nm, hole.perimeter_nm);
  }
  if (longest_nm == 0) return;
  print_note(fmt::format("--max-hole {:.4g}nm would fill the holes left open, were that wanted",
                         1.001 * longest_nm));   // rounding to four digits never goes below it
}

void print_simplified(const SimplifySummary& s) {
  fmt::print("{:<10} {} triangles to {}, {}\n", "simplify", s.triangles_before, s.triangles_after,
             s.attempts == 0 || s.triangles_after == s.triangles_before
                 ? "nothing could be removed"
                 : fmt::format("at most {} apart (original to result {}, back {}), measured every {}",
                               format_length(s.deviation.largest_nm()),
                               format_length(s.deviation.from_first_nm),
                               format_length(s.deviation.from_second_nm),
                               format_length(s.deviation.spacing_nm)));
}

int work(const Options& o) {
  const Plan plan = make_plan(o);
  TriangleMesh mesh = io::read_mesh(o.input, plan.unit_nm);
  if (plan.scale != 1) transform(mesh, plan.scale, {});
  if (o.repair) {
    RepairSummary summary;
    mesh = repair_mesh(mesh, plan.repair, summary);
    if (!o.quiet) {
      print_repair(summary);
      advise(summary);
    }
  }
  if (plan.smooth.iterations > 0) mesh = smooth_mesh(mesh, plan.smooth);
  if (o.simplify || o.triangles) {
    SimplifySummary summary;
    mesh = simplify_mesh(mesh, plan.simplify, summary);
    if (!o.quiet) print_simplified(summary);
    if (!summary.reached) {
      print_warning(fmt::format("--triangles: {} are left; fewer would {}", summary.triangles_after,
                                o.simplify ? "exceed --simplify" : "turn faces over"));
    }
  }
  io::write_mesh(*o.output, mesh, plan.out_unit_nm);
  const MeshReport report = check_mesh(mesh);
  if (!o.quiet) {
    fmt::print("{:<10} {}\n", "shape", summary(report));
    fmt::print("{:<10} {}\n", "size", format_extent(report.bounds_nm));
    fmt::print("{:<10} {}\n", "written", *o.output);
  }
  if (!report.closed_and_oriented && !o.repair) {
    print_warning("the mesh is not closed or not oriented. Try --repair");
  }
  return 0;
}

}  // namespace

void add_mesh(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("mesh", "Convert, repair, smooth and simplify a mesh");
  sub->group("Commands");
  sub->add_option("INPUT", o->input, "The mesh: STL, OBJ, PLY, OFF, glTF, VTP")->type_name("FILE");
  const char* units = "Units";
  sub->add_option("--unit", o->unit, "Length of one unit of the input (nm; glTF: m)")
      ->type_name("nm|um|mm|m|pm|A|in")->group(units);
  sub->add_option("--out-unit", o->out_unit, "Length of one unit of the output (nm)")
      ->type_name("nm|um|mm|m|pm|A|in")->group(units);
  sub->add_option("--scale", o->scale, "Multiply all coordinates by this (1)")
      ->type_name("FACTOR")->group(units);
  const char* repair = "Repair";
  sub->add_flag("--repair", o->repair, "Merge, stitch, orient, fill holes, resolve self-intersections")
      ->group(repair);
  sub->add_option("--stitch", o->stitch, "Rims nearer than this are joined (1e-6 of the diagonal)")
      ->type_name("LENGTH")->group(repair);
  sub->add_option("--sliver", o->sliver, "Triangles flatter than this are removed (0nm)")
      ->type_name("LENGTH")->group(repair);
  sub->add_option("--max-hole", o->max_hole,
                  "Longest rim of a hole to fill (the diagonal of its component)")
      ->type_name("LENGTH")->group(repair);
  sub->add_option("--min-component", o->min_component, "Drop parts smaller than this (0nm)")
      ->type_name("LENGTH")->group(repair);
  sub->add_flag("--keep-intersections", o->keep_intersections, "Count self-intersections only")
      ->group(repair);
  const char* shape = "Shape";
  sub->add_option("--smooth", o->smooth, "Taubin smoothing, this many times")
      ->type_name("N")->group(shape);
  sub->add_option("--simplify", o->simplify, "Fewer triangles, nowhere farther off than this")
      ->type_name("LENGTH")->group(shape);
  sub->add_option("--triangles", o->triangles, "Fewer triangles, down to this many")
      ->type_name("N")->group(shape);
  const char* output = "Output";
  sub->add_option("-o,--output", o->output, "Mesh to write: .stl .obj .ply .off .vtp")
      ->type_name("FILE")->group(output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
