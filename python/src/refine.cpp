// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh that agrees with SEM images from several sides.
#include "arrays.h"
#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/workflow/refine_job.h"

namespace surf::python {
namespace {

TriangleMesh start_of(const Call& call, std::filesystem::path& file) {
  const py::object given = call["start"];
  const auto request = call.told<io::SpecimenRequest>();
  const io::MeshUnit unit{request.mesh_unit_nm, request.override_unit};
  if (!is_path(given)) {
    if (py::isinstance<Mesh>(given)) return mesh_of(given, unit, "start").mesh;
    return height_field_sheet(heights_of(given, {}, "start").field);
  }
  file = path_of(given);
  std::vector<std::string> notes;
  TriangleMesh mesh = workflow::read_refined_start(file, unit, notes);
  Call::notes(notes);
  return mesh;
}

workflow::RefineJob job_of(const Call& call) {
  workflow::RefineJob job;
  job.cache = io::cache_folder("");
  call.apply(job);
  if (mc::Material material = material_of(call); !material.name.empty())
    job.material = std::move(material);
  if (!call.is_given("beam.energy"))
    throw UsageError("`beam.energy`", "it is missing",
                     "Say what the images were taken with, as `beam.energy=1keV`");
  job.start = start_of(call, job.start_file);
  job.images = sems_of(call, "sem");
  if (!job.folder.empty()) {
    require_file(job.start_file, "start");
    for (const workflow::SemInput& image : job.images) require_file(image.file, "sem");
  }
  return job;
}

py::object found_of(const workflow::RefinedImage& image, const Placement& placement) {
  py::dict d;
  d["tilt_deg"] = image.tilt_deg;
  d["azimuth_deg"] = image.azimuth_deg;
  d["shift_nm"] = py::make_tuple(image.state.shift_x_nm, image.state.shift_y_nm);
  d["gain"] = image.state.gain;
  d["offset"] = image.state.offset;
  d["unexplained_share_before"] = image.unexplained_before;
  d["unexplained_share"] = image.unexplained;
  d["simulated"] = picture_of(image.simulated, placement, "simulated");
  d["residual"] = array_of(image.residual);
  d["sensitivity_per_nm"] = array_of(image.sensitivity_per_nm);
  return findings(d);
}

py::object refine(const Call& call) {
  const workflow::RefineJob job = job_of(call);
  workflow::RefineSummary s;
  call.work([&](const workflow::Reporter& reporter) { s = workflow::run(job, reporter); });
  for (const std::string& reason : s.reasons) Call::warn(reason);
  py::dict d;
  py::list images, sensitivity, reasons;
  for (std::size_t k = 0; k < s.images.size(); ++k)
    images.append(found_of(s.images[k], job.images[k].image.placement()));
  for (std::vector<double>& view : s.sensitivity) sensitivity.append(array_of(std::move(view)));
  for (const std::string& reason : s.reasons) reasons.append(with_keywords(reason));
  Mesh mesh;
  mesh.mesh = std::move(s.mesh);
  d["mesh"] = object_of(std::move(mesh));
  d["stderr_nm"] = array_of(std::move(s.deviation_nm));
  d["displacement_nm"] = array_of(std::move(s.displacement_nm));
  d["sensitivity_per_nm"] = sensitivity;
  d["images"] = images;
  d["self_intersections"] = s.self_intersections;
  d["simulated_primaries"] = s.primaries;
  d["reasons"] = reasons;
  d["written"] = list_of(s.written);
  return findings(d);
}

}  // namespace

void add_refine(py::module_& module) {
  Function f{
      .name = "refine",
      .summary = "Let a mesh, undercuts included, agree with SEM images from several sides."};
  f.details =
      "Vertices of the mesh move until simulated images of it agree with the SEM images: first "
      "the\n"
      "whole shape (sizes, angles of walls), then bumps. The start is a closed body, or a sheet "
      "that\n"
      "goes on level beyond its rim.";
  f.arguments = {{"start", "PathLike | Mesh | HeightField | ArrayLike",
                  "A mesh that is about right: drawn, or a reconstruction.", true, false},
                 {"sem", "PathLike | Image | ArrayLike | Sequence",
                  "The SEM images, each from its side (`tilt`, `azimuth`).", true, false}};
  f.takes<io::MaterialChoice>()
      .takes<io::SpecimenRequest>({}, all_but_units)
      .takes<workflow::RefineJob>();
  f.result_type = "Findings";
  f.result =
      "The `mesh`, the standard error `stderr_nm` and the `displacement_nm` of each vertex, what "
      "each image tells of it (`sensitivity_per_nm`), and `images`. `reasons` say why not to trust "
      "it.";
  define(module, f, refine);
}

}  // namespace surf::python
