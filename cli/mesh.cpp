// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "commands.h"
#include "common_options.h"
#include "info.h"
#include "mesh_attributes.h"
#include "mesh_inputs.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/mesh_file.h"
#include "surf/io/surface_file.h"
#include "surf/io/tracks_file.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Inputs are meshes and scans (FILE:CHANNEL chooses a channel); .glb, .gltf, .3mf, .obj, .vtp and .vtm keep
several apart. What is asked for happens in this order: unit, scale, repair, smooth, simplify, solid. Nothing of
it: the mesh is converted. 'semsurf info' says what is wrong with a mesh.
glTF, 3MF, STL and OBJ show the specimen a million times larger, 1 nm as 1 mm; reading undoes it.

Examples:
  semsurf mesh scan.gwy --tolerance 0.1nm -o scan.glb
  semsurf mesh scan.gsf --solid --triangles 200000 -o print.3mf
  semsurf mesh eroded.gsf --scalar map.tif:certain --drape sem.exr:SE --tracks tracks.vtp -o all.glb
  semsurf mesh before.gsf after.gsf -o both.vtm
  semsurf mesh part.stl --unit um -o part.ply
  semsurf mesh broken.obj --repair --max-hole 200nm -o sound.stl
  semsurf mesh scan.ply --smooth 20 --triangles 50000 --out-unit um -o model.obj)";

struct Options {
  std::vector<std::string> inputs, scalars;
  std::optional<std::string> output, unit, z_unit, pixel_size, out_unit, scale, smooth, tolerance, triangles;
  std::optional<std::string> stitch, sliver, max_hole, min_component;
  std::optional<std::string> thickness, drape, tracks, magnification, z_exaggeration;
  bool override_unit = false, repair = false, keep_intersections = false, solid = false, true_size = false, plain = false, quiet = false;
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
  io::SurfaceFormat format;
  MeshWork work;
  io::Magnification magnification;
  std::optional<double> out_unit_nm;
  std::vector<FileChannel> inputs, scalars;
  std::optional<FileChannel> drape;
};

RepairOptions make_repair(const Options& o) {
  RepairOptions repair;
  if (o.stitch) repair.stitch_nm = parse_distance(*o.stitch, "--stitch", true);
  if (o.sliver) repair.sliver_nm = parse_distance(*o.sliver, "--sliver", true);
  if (o.max_hole) repair.max_hole_nm = parse_distance(*o.max_hole, "--max-hole", true);
  if (o.min_component) repair.min_component_nm = parse_distance(*o.min_component, "--min-component", true);
  repair.resolve_self_intersections = !o.keep_intersections;
  const bool for_repair = o.stitch || o.sliver || o.max_hole || o.min_component || o.keep_intersections;
  if (for_repair && !o.repair) {
    throw UsageError(o.max_hole ? "--max-hole" : o.stitch ? "--stitch" : o.sliver ? "--sliver"
                     : o.min_component ? "--min-component" : "--keep-intersections",
                     "it is about repairs, and there are none", "Add --repair");
  }
  return repair;
}

MeshWork make_work(const Options& o, const io::SurfaceFormat& format) {
  MeshWork w;
  w.quiet = o.quiet;
  w.unit = parse_mesh_unit(o.unit, o.override_unit);
  if (o.z_unit) w.z_unit_nm = parse_unit_nm(*o.z_unit, "--z-unit");
  if (o.pixel_size) {
    const auto [x, y] = parse_pixel_size(*o.pixel_size, "--pixel-size");
    w.pitch = {x, y};
  }
  if (o.scale) w.scale = parse_factor(*o.scale, "--scale");
  const RepairOptions repair = make_repair(o);
  if (o.repair) w.repair = repair;
  w.smooth.iterations = o.smooth ? static_cast<int>(parse_whole(*o.smooth, "--smooth", 1, 100000)) : 0;
  if (o.tolerance) w.reduce.tolerance_nm = parse_distance(*o.tolerance, "--tolerance", false);
  if (o.triangles)
    w.reduce.triangles = static_cast<std::size_t>(parse_whole(*o.triangles, "--triangles", 4, 1'000'000'000));
  if (o.thickness && !o.solid)
    throw UsageError("--thickness", "it is that of a solid's base", "Add --solid");
  if (o.solid) w.solid_nm = o.thickness ? parse_distance(*o.thickness, "--thickness", false) : 0;
  w.curvature = format.scalars && !o.plain;
  w.keep_bodies = format.several || format.scalars;
  return w;
}

void refuse_what_the_format_lacks(const Options& o, const io::SurfaceFormat& format) {
  const auto refuse = [&](const char* option, const char* what, bool io::SurfaceFormat::*held) {
    std::vector<std::string> others;
    for (const io::SurfaceFormat& f : io::surface_formats())
      if (f.*held) others.push_back(f.extension);
    throw UsageError(option, fmt::format("{} files hold no {}", format.extension, what),
                     fmt::format("Write one of {}", fmt::join(others, " ")));
  };
  if (!o.scalars.empty() && !format.scalars) refuse("--scalar", "scalars", &io::SurfaceFormat::scalars);
  if (o.drape && !format.drape) refuse("--drape", "pictures", &io::SurfaceFormat::drape);
  if (o.tracks && !format.tracks) refuse("--tracks", "tracks", &io::SurfaceFormat::tracks);
  const char* const enlarging = o.magnification    ? "--magnification"
                                : o.true_size      ? "--true-size"
                                : o.z_exaggeration ? "--z-exaggeration"
                                                   : nullptr;
  if (!enlarging) return;
  if (!format.magnified) refuse(enlarging, "magnification, they hold nm", &io::SurfaceFormat::magnified);
  if (o.out_unit)
    throw UsageError(enlarging, "--out-unit says how large the file is already", "Leave one of them out");
  if (o.magnification && o.true_size)
    throw UsageError("--true-size", "--magnification says how large the file is already", "Leave one of them out");
}

Plan make_plan(const Options& o) {
  if (o.inputs.empty()) throw UsageError("mesh", "no mesh is given", "Name a file to read");
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o mesh.ply");
  Plan p{io::check_surface_target(*o.output), {}, {}, {}, {}, {}, {}};
  refuse_what_the_format_lacks(o, p.format);
  p.work = make_work(o, p.format);
  if (o.out_unit) p.out_unit_nm = parse_unit_nm(*o.out_unit, "--out-unit");
  if (o.magnification) p.magnification.factor = parse_factor(*o.magnification, "--magnification");
  if (o.true_size) p.magnification.factor = 1;
  if (o.z_exaggeration) p.magnification.z_exaggeration = parse_factor(*o.z_exaggeration, "--z-exaggeration");
  for (const std::string& input : o.inputs) p.inputs.push_back(parse_file_channel(input));
  for (const std::string& input : o.scalars) p.scalars.push_back(parse_file_channel(input));
  if (o.drape) p.drape = parse_file_channel(*o.drape);
  return p;
}

std::map<std::string, std::string> provenance(const Options& o, const Plan& p) {
  std::map<std::string, std::string> made;
  const auto add = [&](const char* name, const std::optional<std::string>& value) {
    if (value) made[name] = *value;
  };
  add("unit", o.unit), add("z-unit", o.z_unit), add("pixel-size", o.pixel_size), add("scale", o.scale);
  add("smooth", o.smooth), add("tolerance", o.tolerance), add("triangles", o.triangles);
  add("stitch", o.stitch), add("sliver", o.sliver), add("max-hole", o.max_hole);
  add("min-component", o.min_component), add("thickness", o.thickness);
  if (o.repair) made["repair"] = o.keep_intersections ? "keep-intersections" : "on";
  if (o.solid) made["solid"] = "on";
  if (o.override_unit) made["override-unit"] = "on";
  std::vector<std::string> files;
  for (const FileChannel& f : p.inputs) files.push_back(f.file.string());
  for (const FileChannel& f : p.scalars) files.push_back(f.file.string());
  if (p.drape) files.push_back(p.drape->file.string());
  if (o.tracks) files.push_back(*o.tracks);
  return workflow::step_record("mesh", made, {files.begin(), files.end()});
}

SurfaceScene make_scene(const Options& o, const Plan& p, Watched& watched) {
  SurfaceScene scene;
  for (std::size_t i = 0; i < p.inputs.size(); ++i) {
    const auto share = static_cast<double>(p.inputs.size());
    add_mesh_input(p.inputs[i], p.work, watched.watch(static_cast<double>(i) / share, static_cast<double>(i + 1) / share),
                   scene);
    watched.clear();
  }
  if (p.format.scalars && !o.plain) add_shape_scalars(scene, watched.watch());
  for (const FileChannel& input : p.scalars) add_image_scalar(input, p.work.pitch, scene);
  if (p.drape) add_drape(*p.drape, p.work.pitch, scene);
  if (!p.format.tracks) scene.tracks.clear();
  if (o.tracks) scene.tracks = io::read_tracks(*o.tracks);
  scene.metadata = provenance(o, p);
  return scene;
}

/// "1 nm is 1 mm".
std::string scale_of(const io::Magnification& m) {
  std::string text = fmt::format("1 nm is {} in the file", format_length(m.factor));
  if (m.factor == 1) text = "true size; many programs cannot show or treat anything as small";
  if (m.z_exaggeration != 1) text += fmt::format(", and heights are {:.6g} times larger still", m.z_exaggeration);
  return text;
}

/// Returns whether each surface is closed and oriented.
bool print_surfaces(const SurfaceScene& scene, bool quiet) {
  bool sound = true;
  Box box;
  for (const Surface& surface : scene.surfaces) {
    const MeshReport report = check_mesh(surface.mesh);
    sound = sound && report.closed_and_oriented;
    box.extend(report.bounds_nm.lower_nm);
    box.extend(report.bounds_nm.upper_nm);
    if (quiet) continue;
    std::string with;
    for (const VertexScalar& scalar : surface.scalars) with += (with.empty() ? "; with " : ", ") + scalar.name;
    if (surface.drape) with += (with.empty() ? "; with " : ", ") + fmt::format("the picture {}", surface.drape->name);
    print("{:<10} {}{}{}\n", "shape", scene.surfaces.size() > 1 ? surface.name + ": " : "", summary(report), with);
  }
  if (!quiet) print("{:<10} {}\n", "size", format_extent(box));
  return sound;
}

std::vector<std::filesystem::path> write(const Options& o, const Plan& p, const SurfaceScene& scene) {
  if (!p.out_unit_nm) return io::write_surfaces(*o.output, scene, p.magnification);
  if (p.format.magnified) return io::write_surfaces(*o.output, scene, {1e6 / *p.out_unit_nm, 1});
  std::vector<io::NamedMesh> bodies;
  for (const Surface& surface : scene.surfaces) bodies.push_back({surface.name, {}, surface.mesh});
  return io::write_mesh(*o.output, io::join(bodies), *p.out_unit_nm);
}

int work(const Options& o) {
  const Plan plan = make_plan(o);
  Watched watched(!o.quiet);
  const SurfaceScene scene = make_scene(o, plan, watched);
  const std::vector<std::filesystem::path> files = write(o, plan, scene);
  const bool sound = print_surfaces(scene, o.quiet);
  if (!o.quiet) {
    if (!scene.tracks.empty()) print("{:<10} {}\n", "tracks", scene.tracks.size());
    if (plan.format.magnified && !plan.out_unit_nm) print("{:<10} {}\n", "scale", scale_of(plan.magnification));
    print_written(files);
  }
  const bool of_meshes = std::ranges::all_of(plan.inputs, [](const FileChannel& f) { return io::is_mesh_file(f.file); });
  if (!sound && !o.repair && of_meshes) {
    print_warning("the mesh is not closed or not oriented. Try --repair");
  } else if (!sound && (plan.format.extension == ".stl" || plan.format.extension == ".3mf") && !o.solid) {
    print_note("an open sheet: slicers and CAD want a body, which --solid makes of it");
  }
  return 0;
}

}  // namespace

void add_mesh(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("mesh", "Meshes and scans to glTF, CAD and ParaView; repair, simplify");
  sub->add_option("INPUTS", o->inputs, "Meshes (STL, OBJ, PLY, OFF, glTF, 3MF, VTP, VTM) and scans")->type_name("FILE");
  const char* units = "Units";
  add_unit_options(*sub, o->unit, o->override_unit, units);
  sub->add_option("--z-unit", o->z_unit, "Length of one unit of height, of scans that do not say (nm)")
      ->type_name("LENGTH")->group(units);
  sub->add_option("--pixel-size", o->pixel_size, "Of scans and pictures that do not say, 2nm or 2nmx3nm (1 nm)")
      ->type_name("LENGTH")->group(units);
  sub->add_option("--out-unit", o->out_unit, "Length of one unit of the output, in place of a magnification (nm)")
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
  sub->add_option("--tolerance,--simplify", o->tolerance, "Fewer triangles, nowhere farther off than this")
      ->type_name("LENGTH")->group(shape);
  sub->add_option("--triangles", o->triangles, "Fewer triangles, down to this many")
      ->type_name("N")->group(shape);
  sub->add_flag("--solid", o->solid, "Walls and a base under an open sheet: a closed body")->group(shape);
  sub->add_option("--thickness", o->thickness, "Of the base under the lowest place (5 % of the longer side)")
      ->type_name("LENGTH")->group(shape);
  const char* shown = "On the surface";
  sub->add_option("--scalar", o->scalars, "A map to go along, FILE or FILE:CHANNEL; may be repeated")
      ->type_name("FILE")->option_text("FILE")->allow_extra_args(false)->group(shown);
  sub->add_option("--drape", o->drape, "A picture to lay on it, FILE or FILE:CHANNEL")->type_name("FILE")->group(shown);
  sub->add_option("--tracks", o->tracks, "Paths of electrons, as 'simulate --trajectories' writes them")
      ->type_name("FILE.vtp")->group(shown);
  sub->add_flag("--plain", o->plain, "Without height and curvature as scalars")->group(shown);
  const char* output = "Output";
  std::string suffixes;
  for (const io::SurfaceFormat& format : io::surface_formats()) suffixes += " " + format.extension;
  sub->add_option("-o,--output", o->output, "To write:" + suffixes)->type_name("FILE")->group(output);
  sub->add_option("--magnification", o->magnification, "Of glTF, 3MF, STL and OBJ (1e6: 1 nm is 1 mm)")
      ->type_name("FACTOR")->group(output);
  sub->add_flag("--true-size", o->true_size, "Magnification 1")->group(output);
  sub->add_option("--z-exaggeration", o->z_exaggeration, "Heights so much larger still, in these formats (1)")
      ->type_name("FACTOR")->group(output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
