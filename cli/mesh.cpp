// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bound_parameters.h"
#include "commands.h"
#include "common_options.h"
#include "info.h"
#include "mesh_attributes.h"
#include "mesh_inputs.h"
#include "mesh_parameters.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/mesh_file.h"
#include "surf/io/surface_file.h"
#include "surf/io/tracks_file.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* mesh_examples =
    R"(Inputs are meshes and scans (FILE:CHANNEL chooses a channel); .glb, .gltf, .3mf, .obj, .vtp and .vtm keep
several apart. What is asked for happens in this order: unit, scale, repair, smooth, simplify, solid. Nothing of
it: the mesh is converted. 'semsurf info' says what is wrong with a mesh.
glTF, 3MF, STL and OBJ show the specimen a million times larger, 1 nm as 1 mm; reading undoes it.

Examples:
  semsurf mesh scan.gwy --mesh-tolerance 0.1nm -o scan.glb
  semsurf mesh scan.gsf --solid --triangles 200000 -o print.3mf
  semsurf mesh eroded.gsf --scalar map.tif:certain --drape sem.exr:SE --tracks tracks.vtp -o all.glb
  semsurf mesh before.gsf after.gsf -o both.vtm
  semsurf mesh part.stl --unit um -o part.ply
  semsurf mesh broken.obj --repair --max-hole 200nm -o sound.stl
  semsurf mesh scan.ply --smooth 20 --triangles 50000 --out-unit um -o model.obj)";

struct MeshArguments {
  std::vector<std::string> inputs, scalars;
  std::optional<std::string> output, drape, tracks;
  BoundParameters bound;
  bool quiet = false;
};

/// All the numbers, before a large mesh is read.
struct Plan {
  io::SurfaceFormat format;
  MeshParameters parameters;
  io::SpecimenRequest reading;
  workflow::GivenPitch pixel;  ///< of pictures, and of scans where nothing else is said
  MeshWork work;
  io::Magnification magnification;
  std::vector<workflow::FileChannel> inputs, scalars;
  std::optional<workflow::FileChannel> drape;
};

void check_repair(const MeshParameters& p, const BoundParameters& bound) {
  for (const char* of_repair : {"mesh.max_hole", "mesh.stitch", "mesh.sliver", "mesh.min_component",
                                "mesh.keep_intersections"})
    if (bound.is_given(of_repair) && !p.repair)
      throw UsageError(option_name(of_repair), "it is about repairs, and there are none",
                       "Add --repair");
}

MeshWork make_work(const MeshArguments& o, const Plan& plan) {
  const MeshParameters& p = plan.parameters;
  MeshWork w;
  w.quiet = o.quiet;
  w.unit = mesh_unit_of(plan.reading);
  w.z_unit_nm = plan.reading.heights.z_unit_nm;
  w.pitch = plan.reading.heights.pitch_x_nm ? workflow::GivenPitch{plan.reading.heights.pitch_x_nm,
                                                                   plan.reading.heights.pitch_y_nm}
                                            : plan.pixel;
  w.scale = p.scale;
  check_repair(p, o.bound);
  if (p.repair) w.repair = p.mending;
  w.smooth.iterations = p.smooth.value_or(0);
  w.reduce = p.reduce;
  if (p.thickness_nm && !p.solid)
    throw UsageError("--thickness", "it is that of a solid's base", "Add --solid");
  if (p.solid) w.solid_nm = p.thickness_nm.value_or(0);
  w.curvature = plan.format.scalars && !p.plain;
  w.keep_bodies = plan.format.several || plan.format.scalars;
  return w;
}

void refuse_what_the_format_lacks(const MeshArguments& o, const MeshParameters& p,
                                  const io::SurfaceFormat& format) {
  const auto refuse = [&](const char* option, const char* what, bool io::SurfaceFormat::*held) {
    std::vector<std::string_view> others;
    for (const io::SurfaceFormat& f : io::surface_formats())
      if (f.*held) others.push_back(f.extension);
    throw UsageError(option, fmt::format("{} files hold no {}", format.extension, what),
                     fmt::format("Write one of {}", fmt::join(others, " ")));
  };
  if (!o.scalars.empty() && !format.scalars)
    refuse("--scalar", "scalars", &io::SurfaceFormat::scalars);
  if (o.drape && !format.drape) refuse("--drape", "pictures", &io::SurfaceFormat::drape);
  if (o.tracks && !format.tracks) refuse("--tracks", "tracks", &io::SurfaceFormat::tracks);
  const char* const enlarging = p.magnification    ? "--magnification"
                                : p.true_size      ? "--true-size"
                                : p.z_exaggeration ? "--z-exaggeration"
                                                   : nullptr;
  if (!enlarging) return;
  if (!format.magnified)
    refuse(enlarging, "magnification, they hold nm", &io::SurfaceFormat::magnified);
  if (p.out_unit_nm)
    throw UsageError(enlarging, "--out-unit says how large the file is already",
                     "Leave one of them out");
  if (p.magnification && p.true_size)
    throw UsageError("--true-size", "--magnification says how large the file is already",
                     "Leave one of them out");
}

Plan make_plan(const MeshArguments& o) {
  if (o.inputs.empty()) throw UsageError("mesh", "no mesh is given", "Name a file to read");
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o mesh.ply");
  Plan p;
  p.format = io::check_surface_target(*o.output);
  o.bound.apply(p.parameters), o.bound.apply(p.reading), o.bound.apply(p.pixel);
  refuse_what_the_format_lacks(o, p.parameters, p.format);
  p.work = make_work(o, p);
  if (p.parameters.magnification) p.magnification.factor = *p.parameters.magnification;
  if (p.parameters.true_size) p.magnification.factor = 1;
  if (p.parameters.z_exaggeration) p.magnification.z_exaggeration = *p.parameters.z_exaggeration;
  for (const std::string& input : o.inputs) p.inputs.push_back(workflow::parse_file_channel(input));
  for (const std::string& input : o.scalars)
    p.scalars.push_back(workflow::parse_file_channel(input));
  if (o.drape) p.drape = workflow::parse_file_channel(*o.drape);
  return p;
}

std::map<std::string, std::string> provenance(const MeshArguments& o, const Plan& p) {
  std::vector<std::string> files;
  for (const workflow::FileChannel& f : p.inputs) files.push_back(f.file.string());
  for (const workflow::FileChannel& f : p.scalars) files.push_back(f.file.string());
  if (p.drape) files.push_back(p.drape->file.string());
  if (o.tracks) files.push_back(*o.tracks);
  return workflow::step_record("mesh", workflow::records_of(p.reading, p.pixel, p.parameters),
                               {files.begin(), files.end()});
}

/// Maps of a scan's format may lie as the scan does.
workflow::GivenPitch picture_pitch(const Plan& p) { return p.pixel.x_nm ? p.pixel : p.work.pitch; }

SurfaceScene make_scene(const MeshArguments& o, const Plan& p, Watched& watched) {
  SurfaceScene scene;
  for (std::size_t i = 0; i < p.inputs.size(); ++i) {
    const auto share = static_cast<double>(p.inputs.size());
    add_mesh_input(
        p.inputs[i], p.work,
        watched.watch(static_cast<double>(i) / share, static_cast<double>(i + 1) / share), scene);
    watched.clear();
  }
  if (p.format.scalars && !p.parameters.plain) add_shape_scalars(scene, watched.watch());
  for (const workflow::FileChannel& input : p.scalars)
    add_image_scalar(input, picture_pitch(p), scene);
  if (p.drape) add_drape(*p.drape, picture_pitch(p), scene);
  if (!p.format.tracks) scene.tracks.clear();
  if (o.tracks) scene.tracks = io::read_tracks(*o.tracks);
  scene.metadata = provenance(o, p);
  return scene;
}

/// "1 nm is 1 mm".
std::string scale_of(const io::Magnification& m) {
  std::string text = fmt::format("1 nm is {} in the file", format_length(m.factor));
  if (m.factor == 1) text = "true size; many programs cannot show or treat anything as small";
  if (m.z_exaggeration != 1)
    text += fmt::format(", and heights are {:.6g} times larger still", m.z_exaggeration);
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
    for (const VertexScalar& scalar : surface.scalars)
      with += (with.empty() ? "; with " : ", ") + scalar.name;
    if (surface.drape)
      with +=
          (with.empty() ? "; with " : ", ") + fmt::format("the picture {}", surface.drape->name);
    print("{:<10} {}{}{}\n", "shape", scene.surfaces.size() > 1 ? surface.name + ": " : "",
          summary(report), with);
  }
  if (!quiet) print("{:<10} {}\n", "size", format_extent(box));
  return sound;
}

std::vector<std::filesystem::path> write(const MeshArguments& o, const Plan& p,
                                         const SurfaceScene& scene) {
  const std::optional<double>& out_unit_nm = p.parameters.out_unit_nm;
  if (!out_unit_nm) return io::write_surfaces(*o.output, scene, p.magnification);
  if (p.format.magnified) return io::write_surfaces(*o.output, scene, {1e6 / *out_unit_nm, 1});
  std::vector<io::NamedMesh> bodies;
  for (const Surface& surface : scene.surfaces) bodies.push_back({surface.name, {}, surface.mesh});
  return io::write_mesh(*o.output, io::join(bodies), *out_unit_nm);
}

int mesh_work(const MeshArguments& o) {
  const Plan plan = make_plan(o);
  Watched watched(!o.quiet);
  const SurfaceScene scene = make_scene(o, plan, watched);
  const std::vector<std::filesystem::path> files = write(o, plan, scene);
  const bool sound = print_surfaces(scene, o.quiet);
  if (!o.quiet) {
    if (!scene.tracks.empty()) print("{:<10} {}\n", "tracks", scene.tracks.size());
    if (plan.format.magnified && !plan.parameters.out_unit_nm)
      print("{:<10} {}\n", "scale", scale_of(plan.magnification));
    print_written(files);
  }
  const bool of_meshes = std::ranges::all_of(
      plan.inputs, [](const workflow::FileChannel& f) { return io::is_mesh_file(f.file); });
  if (!sound && !plan.parameters.repair && of_meshes) {
    print_warning("the mesh is not closed or not oriented. Try --repair");
  } else if (!sound && (plan.format.extension == ".stl" || plan.format.extension == ".3mf") &&
             !plan.parameters.solid) {
    print_note("an open sheet: slicers and CAD want a body, which --solid makes of it");
  }
  return 0;
}

}  // namespace

void add_mesh(CLI::App& app, Action& action) {
  const auto o = std::make_shared<MeshArguments>();
  CLI::App* sub =
      app.add_subcommand("mesh", "Meshes and scans to glTF, CAD and ParaView; repair, simplify");
  with_role(sub->add_option("INPUTS", o->inputs,
                            "Meshes (STL, OBJ, PLY, OFF, glTF, 3MF, VTP, VTM) and scans")
                ->type_name("FILE"),
            FileRole::read);
  o->bound.looks["scan.height_unit"].former = {"--z-unit"};
  o->bound.looks["mesh.mesh_tolerance"].former = {"--tolerance", "--simplify"};
  o->bound.add<io::SpecimenRequest>(*sub, "Reading", {}, surface_readings);
  o->bound.add<workflow::GivenPitch>(*sub, "Reading");
  const auto add = [&](const char* heading, const std::vector<std::string>& names) {
    o->bound.add<MeshParameters>(*sub, heading, {}, names);
  };
  add("Repair", {"mesh.repair", "mesh.stitch", "mesh.sliver", "mesh.max_hole", "mesh.min_component",
                 "mesh.keep_intersections"});
  add("Shape", {"mesh.scale", "mesh.smooth", "mesh.mesh_tolerance", "mesh.triangles", "mesh.solid",
                "mesh.thickness"});
  const char* shown = "On the surface";
  with_role(sub->add_option("--scalar", o->scalars,
                            "Map to store with the vertices, FILE or FILE:CHANNEL; may be repeated")
                ->type_name("FILE")
                ->option_text("FILE")
                ->allow_extra_args(false)
                ->group(shown),
            FileRole::read);
  with_role(sub->add_option("--drape", o->drape,
                            "Picture to drape over the surface, FILE or FILE:CHANNEL")
                ->type_name("FILE")
                ->group(shown),
            FileRole::read);
  with_role(sub->add_option("--tracks", o->tracks,
                            "Paths of electrons, as 'simulate --trajectories' writes them")
                ->type_name("FILE.vtp")
                ->group(shown),
            FileRole::read);
  add(shown, {"mesh.plain"});
  const char* output = "Output";
  std::string suffixes;
  for (const io::SurfaceFormat& format : io::surface_formats())
    suffixes += fmt::format(" {}", format.extension);
  with_role(sub->add_option("-o,--output", o->output, "File to write:" + suffixes)
                ->type_name("FILE")
                ->group(output),
            FileRole::written);
  add(output, {"mesh.out_unit", "mesh.magnification", "mesh.true_size", "mesh.z_exaggeration"});
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(mesh_examples);
  sub->callback([o, &action] { action = [o] { return mesh_work(*o); }; });
}

}  // namespace surf::cli
