// SPDX-License-Identifier: GPL-3.0-or-later
#include "info.h"

#include <fmt/format.h>

#include <memory>

#include "bound_parameters.h"
#include "commands.h"
#include "failure.h"
#include "mesh_parameters.h"
#include "surf/core/error.h"
#include "surf/core/field_words.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/sem_file.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/scene_file.h"
#include "surf/workflow/describe_file.h"
#include "surf/workflow/simulate_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* info_examples = R"(Examples:
  semsurf info part.stl --unit um      is it closed, how large is it
  semsurf info out/cube.exr            channels, and every setting that made the image
  semsurf info scan.gwy                channels, pixels, heights and what the microscope noted
  semsurf info si-1keV-3nm.json        what a model is for, and how far it is off
  semsurf info samples/mesa80.toml     specimen, scan and physics in words
  semsurf info --json *.spm            numbers for scripts)";

std::string join(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

void print_specimen(const mc::Specimen& specimen) {
  const auto material = [&](int index) {
    return specimen.materials.at(static_cast<std::size_t>(index)).name;
  };
  if (const auto& s = specimen.substrate)
    print_item("substrate",
               fmt::format("{} below z = {}", material(s->material), format_length(s->top_nm)));
  if (const auto& h = specimen.height_field)
    print_item("field",
               fmt::format("{}, {}, {} x {} samples, pitch {} x {}", h->name, material(h->material),
                           h->field.z_nm.width(), h->field.z_nm.height(),
                           format_length(h->field.pitch_x_nm), format_length(h->field.pitch_y_nm)));
  for (const mc::Body& body : specimen.bodies)
    print_item("body", fmt::format("{}, {}, {} triangles, {}", body.name, material(body.material),
                                   body.mesh.triangles.size(), format_extent(bounds(body.mesh))));
  const Box extent = mc::extent(specimen);
  print_item("extent", format_extent(extent));
  print_item("bounds", format_bounds(extent));
}

void print_scan(const io::SceneFile& scene) {
  mc::Beam beam = scene.beam;
  const Record usual = record_of(mc::Beam{});
  std::string settings;
  for_each_parameter(beam, [&](const Parameter& about, Field& field) {
    if (field.kind() != FieldKind::number || !field.given()) return;
    const auto found = usual.find(about.key());
    if (found != usual.end() && found->second == field.text() && about.name != "beam.energy")
      return;
    settings += fmt::format("{}{} {}", settings.empty() ? "" : ", ", last_part(about.name, ' '),
                            format_value(std::stod(field.text()), about.unit));
  });
  print_item("beam", settings);
  const mc::Scan scan = workflow::resolve_scan(scene.scan, mc::extent(scene.specimen), beam);
  print_item("scan", fmt::format("{} x {} pixels of {} x {} about {}, {}, {} nm", scan.width,
                                 scan.height, format_length(scan.pixel_x_nm),
                                 format_length(scan.pixel_y_nm), format_exact(scan.center_x_nm),
                                 format_exact(scan.center_y_nm), format_exact(scan.center_z_nm)));
  for (const mc::Detector& d : scene.detectors) print_item("detector", mc::format_detector(d));
  if (const auto* const dose = std::get_if<mc::Dose>(&scene.budget)) {
    print_item("dose", fmt::format("{} pA for {} us: {:.4g} primaries per pixel",
                                   format_exact(dose->current_pa), format_exact(dose->dwell_us),
                                   dose->electrons));
  } else if (const auto* const accuracy = std::get_if<mc::Accuracy>(&scene.budget)) {
    print_item("accuracy", fmt::format("{}, but no better than {} per primary",
                                       format_share(accuracy->share), accuracy->floor));
  } else if (const auto* const limit = std::get_if<mc::TimeLimit>(&scene.budget)) {
    print_item("time", fmt::format("{:g} s", limit->seconds));
  } else {
    const auto electrons = mc::electrons_of(scene.budget);
    print_item("electrons",
               fmt::format("{} per pixel, {} in all", electrons,
                           format_count(double(electrons) * scan.width * scan.height)));
  }
}

void print_scene(const std::filesystem::path& path,
                 const std::vector<std::filesystem::path>& material_files) {
  const io::SceneFile scene = io::read_scene(path, material_files);
  for (const std::string& note : scene.notes) print_note(note);
  mc::validate(scene.specimen);
  print("{}: scene{}\n", path.string(), scene.title.empty() ? "" : ", \"" + scene.title + "\"");
  print_specimen(scene.specimen);
  print_scan(scene);
  print_item("physics", mc::format_physics(scene.physics));
  for (const mc::Material& material : scene.specimen.materials) {
    print("  in {}\n", material.name);
    for (const std::string& line : mc::describe(scene.physics, material)) print("    {}\n", line);
  }
}

// What no reader of ours knows: a scan for Gwyddion, or nothing that semsurf can use.
void print_foreign_file(const std::filesystem::path& path) {
  try {
    print_height_file(path);
  } catch (const io::UnknownScan&) {
    if (io::has_scan_name(path)) throw;
    throw FileError(path.string(), "it is no mesh, image or AFM scan of a format known here",
                    "Use a mesh (STL, OBJ, PLY, OFF, glTF, 3MF, VTP, VTM), an image (EXR, TIFF, "
                    "PNG, VTI) or a scan "
                    "(.gwy, .gsf, .spm, .ibw, .sxm, text ...); with Gwyddion installed (apt-get "
                    "install gwyddion) "
                    "semsurf reads many more scans");
  }
}

void print_info(const std::filesystem::path& path, const io::MeshUnit& unit,
                const std::vector<std::filesystem::path>& material_files) {
  using workflow::FileKind;
  switch (workflow::kind_of(path)) {
    case FileKind::scene:
      return print_scene(path, material_files);
    case FileKind::model:
      return print_model(path);
    case FileKind::heights:
      return print_height_file(path);
    case FileKind::sem_image:
      return print_sem_image(path);
    case FileKind::image:
      return print_image(path);
    case FileKind::mesh:
      return print_mesh(path, unit);
    case FileKind::unknown:
      break;
  }
  print_foreign_file(path);
}

using Files = std::vector<std::filesystem::path>;

/// Tells each file by `tell`, whatever is wrong with some. The code is that of the first that
/// cannot be shown.
template <class Tell>
int each(const std::vector<std::string>& files, const Tell& tell) {
  int code = 0;
  for (const std::string& file : files) {
    try {
      tell(file);
    } catch (...) {
      flush();  // what was said before the message
      const int failed = report_failure();
      if (code == 0) code = failed;
    }
  }
  return code;
}

/// A list of one object per file.
int print_json(const std::vector<std::string>& files, const io::MeshUnit& unit,
               const Files& material_files) {
  print("[");
  const char* before = "\n";
  const int code = each(files, [&](const std::string& file) {
    const std::string text = workflow::describe_file(file, unit, material_files);
    print("{}{}", before, text);
    before = ",\n";
  });
  print("\n]\n");
  return code;
}

}  // namespace

void print_item(const std::string& label, const std::string& value) {
  print("  {:<10} {}\n", label, value);
}

std::string format_bounds(const Box& box) {
  const Vec3 &a = box.lower_nm, &b = box.upper_nm;
  return fmt::format("x {:.6g} to {:.6g}, y {:.6g} to {:.6g}, z {:.6g} to {:.6g} nm", a.x, b.x, a.y,
                     b.y, a.z, b.z);
}

std::string format_extent(const Box& box) {
  const Vec3 size = box.size_nm();
  return join({format_length(size.x) + " wide", format_length(size.y) + " deep",
               format_length(size.z) + " high"});
}

void add_info(CLI::App& app, Action& action) {
  struct Options {
    BoundParameters bound;
    std::vector<std::string> files;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("info", "What is in meshes, images, AFM scans, models and scene files");
  with_role(sub->add_option("FILE", options->files, "Meshes, images, AFM scans, models or scenes")
                ->type_name("FILE"),
            FileRole::read);
  options->bound.add<io::SpecimenRequest>(*sub, "Options", {},
                                          {"specimen.unit", "specimen.override_unit"});
  options->bound.add<io::MaterialChoice>(*sub, "Options", {}, {"specimen.materials"});
  sub->add_flag("--json", options->json,
                "Print JSON, a list of one object per file, in place of text")
      ->group("Options");
  sub->footer(info_examples);
  sub->callback([options, &action] {
    action = [options] {
      if (options->files.empty())
        throw UsageError("info", "no file is given",
                         "Give meshes, images, AFM scans, models or scene files");
      io::SpecimenRequest request;
      io::MaterialChoice own;
      options->bound.apply(request), options->bound.apply(own);
      const io::MeshUnit unit = mesh_unit_of(request);
      const Files material_files{own.files.begin(), own.files.end()};
      if (options->json) return print_json(options->files, unit, material_files);
      return each(options->files,
                  [&](const std::string& file) { print_info(file, unit, material_files); });
    };
  });
}

}  // namespace surf::cli
