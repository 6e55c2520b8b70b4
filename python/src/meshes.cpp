// SPDX-License-Identifier: GPL-3.0-or-later
// Checking, repairing and simplifying meshes, and meshes of heights.
#include <fmt/format.h>

#include <algorithm>

#include "arrays.h"
#include "data.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/sheet_solid.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/smooth_mesh.h"
#include "surf/mesh/thin_height_field.h"
#include "surf/workflow/step_record.h"

namespace surf::python {
namespace {

const Argument mesh_argument{"mesh", "PathLike | Mesh", "The mesh, or its file.", true, false};

Mesh given_mesh(const Call& call) {
  const auto request = call.told<io::SpecimenRequest>();
  return mesh_of(call["mesh"], {request.mesh_unit_nm, request.override_unit}, "mesh");
}

std::vector<std::filesystem::path> files_of(const Made& made) {
  return made.file.empty() ? std::vector<std::filesystem::path>{} : std::vector{made.file};
}

py::tuple tuple_of(const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); }

py::object found_of(const MeshReport& r) {
  py::dict d;
  d["closed_and_oriented"] = r.closed_and_oriented;
  d["summary"] = summary(r);
  py::list faults_found;
  for (const std::string& fault : faults(r)) faults_found.append(fault);
  d["faults"] = faults_found;
  d["vertices"] = r.vertices;
  d["triangles"] = r.triangles;
  d["components"] = r.components;
  d["boundary_edges"] = r.boundary_edges;
  d["nonmanifold_edges"] = r.nonmanifold_edges;
  d["nonmanifold_vertices"] = r.nonmanifold_vertices;
  d["inconsistent_edges"] = r.inconsistent_edges;
  d["degenerate_triangles"] = r.degenerate_triangles;
  d["duplicate_triangles"] = r.duplicate_triangles;
  d["area_nm2"] = r.area_nm2;
  d["volume_nm3"] = r.signed_volume_nm3;
  d["bounds_nm"] = py::make_tuple(tuple_of(r.bounds_nm.lower_nm), tuple_of(r.bounds_nm.upper_nm));
  return findings(d);
}

py::object check(const Call& call) {
  const Mesh mesh = given_mesh(call);
  MeshReport report;
  call.work([&](const workflow::Reporter& reporter) {
    report = check_mesh(mesh.mesh, reporter.watch());
  });
  return found_of(report);
}

py::object repair(const Call& call) {
  auto options = call.told<RepairOptions>();
  options.threads = call.threads();
  Mesh mesh = given_mesh(call);
  RepairedMesh repaired;
  call.work([&](const workflow::Reporter& reporter) {
    options.watch = reporter.watch();
    repaired = repair_mesh(mesh.mesh, options);
  });
  const RepairSummary& s = repaired.summary;
  py::dict found;
  found["sound"] = s.sound();
  found["changed"] = s.changed;
  py::list steps;
  for (const std::string& line : describe(s)) steps.append(line);
  found["steps"] = steps;
  found["before"] = found_of(s.before);
  found["after"] = found_of(s.after);
  found["filled_holes"] = s.filled_holes;
  found["open_holes"] = s.open_holes.size();
  found["self_intersections"] = s.self_intersections_after;
  mesh.record = workflow::step_record("repair_mesh", workflow::records_of(options), files_of(mesh));
  mesh.mesh = std::move(repaired.mesh);
  mesh.file.clear();
  mesh.found = findings(found);
  return object_of(std::move(mesh));
}

py::object simplify(const Call& call) {
  auto options = call.told<SimplifyOptions>();
  options.threads = call.threads();
  Mesh mesh = given_mesh(call);
  SimplifiedMesh simplified;
  call.work([&](const workflow::Reporter& reporter) {
    options.watch = reporter.watch();
    simplified = simplify_mesh(mesh.mesh, options);
  });
  const SimplifySummary& s = simplified.summary;
  py::dict found;
  found["triangles_before"] = s.triangles_before;
  found["triangles_after"] = s.triangles_after;
  found["deviation_nm"] = s.deviation.largest_nm();
  found["reached"] = s.reached;
  mesh.record = workflow::step_record("simplify", workflow::records_of(options), files_of(mesh));
  mesh.mesh = std::move(simplified.mesh);
  mesh.file.clear();
  mesh.found = findings(found);
  return object_of(std::move(mesh));
}

py::object mesh_heights(const Call& call) {
  auto options = call.told<SimplifyOptions>();
  const Heights heights = heights_of(call, "heights");
  Mesh made;
  made.name = heights.file.stem().string();
  ThinSummary summary;
  const bool thins = options.tolerance_nm > 0 || options.triangles > 0;
  call.work([&](const workflow::Reporter& reporter) {
    if (!thins) {
      made.mesh = height_field_sheet(heights.field);
      return;
    }
    ThinSheet thin = thin_height_field(heights.field,
                                       {options.tolerance_nm, options.triangles, reporter.watch()});
    made.mesh = std::move(thin.mesh);
    summary = thin.summary;
  });
  py::dict found;
  if (thins) {
    found["triangles_before"] = summary.triangles_before;
    found["deviation_nm"] = summary.deviation_nm;
    found["reached"] = summary.reached;
  }
  made.found = findings(found);
  made.record = workflow::step_record(
      "mesh_heights", workflow::records_of(options, heights.reading), files_of(heights));
  return object_of(std::move(made));
}

int whole_of(const py::object& value, const char* argument, int otherwise) {
  if (value.is_none()) return otherwise;
  if (!PyLong_Check(value.ptr()))
    throw UsageError(argument, "it is no whole number", "Give 10, say");
  return value.cast<int>();
}

py::object smooth(const Call& call) {
  Mesh mesh = given_mesh(call);
  SmoothOptions options;
  options.iterations = whole_of(call["iterations"], "iterations", options.iterations);
  call.work([&](const workflow::Reporter&) { mesh.mesh = smooth_mesh(mesh.mesh, options); });
  mesh.record = workflow::step_record(
      "smooth", {{"smooth.iterations", std::to_string(options.iterations)}}, files_of(mesh));
  mesh.file.clear();
  return object_of(std::move(mesh));
}

py::object solid(const Call& call) {
  Mesh mesh = given_mesh(call);
  const Box box = bounds(mesh.mesh);
  const Vec3 size = box.size_nm();
  double thickness_nm = 0.05 * std::max(size.x, size.y);
  if (call.has("thickness")) {
    Keyword keyword;
    keyword.parameter = "thickness";
    const std::vector<std::string> texts = texts_of(call["thickness"], keyword);
    thickness_nm = parse_length_nm(texts.front(), "thickness");
  }
  if (!(thickness_nm > 0)) throw UsageError("thickness", "it is not above 0", "Give 50nm, say");
  call.work([&](const workflow::Reporter& reporter) {
    mesh.mesh = sheet_solid(mesh.mesh, box.lower_nm.z - thickness_nm, reporter.watch());
  });
  mesh.record = workflow::step_record(
      "solid", {{"solid.thickness_nm", fmt::format("{:g}", thickness_nm)}}, files_of(mesh));
  mesh.file.clear();
  return object_of(std::move(mesh));
}

Function of_mesh(const char* name, const char* summary) {
  Function f{.name = name, .summary = summary, .arguments = {mesh_argument}};
  f.result_type = "Mesh";
  return f;
}

}  // namespace

void add_meshes(py::module_& module) {
  Function f = of_mesh("check_mesh", "What is wrong with a mesh: holes, edges, orientation.");
  f.result_type = "Findings";
  f.result = "Counts of faults with their places, area, volume; `closed_and_oriented`.";
  define(module, f.takes<io::SpecimenRequest>({}, all_but_units), check);

  f = of_mesh("repair_mesh",
              "Repair a mesh: merge, stitch, orient, fill holes, resolve self-intersections.");
  f.result = "The repaired mesh. `found` says what was done, and whether it is `sound`.";
  define(module, f.takes<RepairOptions>().takes<io::SpecimenRequest>({}, all_but_units), repair);

  f = of_mesh("simplify", "Simplify a mesh: fewer triangles, nowhere farther off than is proven.");
  f.result = "The simplified mesh. `found` has the proven distance.";
  f.example = ">>> small = semsurf.simplify('grain.ply', mesh_tolerance='1nm')";
  define(module, f.takes<SimplifyOptions>().takes<io::SpecimenRequest>({}, all_but_units),
         simplify);

  f = of_mesh("smooth", "Smooth a mesh without shrinking it (Taubin).");
  f.arguments.push_back({"iterations", "int", "Steps in and out; 10 if not given."});
  f.result = "The smoothed mesh, of the same triangles.";
  define(module, f.takes<io::SpecimenRequest>({}, all_but_units), smooth);

  f = of_mesh("solid", "Give an open sheet, as `mesh_heights` makes it, walls and a base.");
  f.arguments.push_back({"thickness", "float | str",
                         "Of the base below the lowest place, nm; a twentieth of the width if "
                         "not given."});
  f.result = "A closed mesh.";
  f.example =
      ">>> semsurf.write_mesh('print.stl', semsurf.solid(semsurf.mesh_heights('scan.gwy')))";
  define(module, f.takes<io::SpecimenRequest>({}, all_but_units), solid);

  Function heights{.name = "mesh_heights",
                   .summary = "The surface of heights as a mesh, thinned where that is asked for."};
  heights.arguments = {{"heights", "PathLike | HeightField | ArrayLike",
                        "The heights; arrays are in nm.", true, false}};
  heights.result_type = "Mesh";
  heights.result = "An open sheet.";
  define(module, heights.takes<SimplifyOptions>().takes<io::HeightReadOptions>(), mesh_heights);
}

}  // namespace surf::python
