// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface differs from another.
#include <fmt/format.h>

#include <cmath>

#include "arrays.h"
#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/workflow/compare_job.h"

namespace surf::python {
namespace {

workflow::ComparedSurface surface_of(const Call& call, const std::string& argument,
                                     std::filesystem::path& file) {
  const py::object given = call[argument];
  const auto reading = call.told<io::HeightReadOptions>();
  const auto request = call.told<io::SpecimenRequest>();
  if (is_path(given)) {
    file = path_of(given);
    std::vector<std::string> notes;
    workflow::ComparedSurface surface = workflow::read_compared_surface(
        file, reading, {request.mesh_unit_nm, request.override_unit}, notes);
    Call::notes(notes);
    return surface;
  }
  if (py::isinstance<Mesh>(given)) return mesh_of(given, {}, argument).mesh;
  return workflow::MeasuredSurface{heights_of(given, reading, argument).field, {}};
}

py::object found_of(const ChangedPlace& p) {
  py::dict d;
  d["centre_nm"] = py::make_tuple(p.centre_nm.x, p.centre_nm.y);
  d["samples"] = p.samples;
  d["area_nm2"] = p.area_nm2;
  d["mean"] = p.mean;
  d["mean_stderr"] = p.mean_error;
  d["volume"] = p.volume;
  d["volume_stderr"] = p.volume_error;
  d["largest"] = p.largest;
  d["score"] = p.score;
  d["probability"] = p.probability;
  return findings(d);
}

py::object found_of(const workflow::CompareSummary& s) {
  py::dict d;
  d["verdict"] = workflow::name(s.verdict);
  py::list reasons, places;
  for (const std::string& reason : s.reasons) reasons.append(with_keywords(reason));
  for (const ChangedPlace& place : s.changes.places) places.append(found_of(place));
  d["reasons"] = reasons;
  d["places"] = places;
  d["unit"] = s.unit;
  if (s.pose) {
    d["transform"] = matrix_of(s.pose->sem_to_afm);
    d["gain"] = s.gain;
    d["offset"] = s.offset;
  } else {
    d["shift_nm"] = py::make_tuple(s.alignment.shift_nm.x, s.alignment.shift_nm.y);
    d["shift_stderr_nm"] =
        py::make_tuple(std::sqrt(s.alignment.covariance[0]), std::sqrt(s.alignment.covariance[6]));
    d["lift_nm"] = s.alignment.lift_nm;
    d["correlation"] = s.alignment.correlation;
    d["overlap"] = s.alignment.overlap;
  }
  if (s.verdict != workflow::CompareVerdict::not_registered) {
    d["threshold"] = s.changes.threshold;
    d["spread"] = s.changes.spread;
    d["deviation_from"] = s.deviation_from;
    d["before"] = picture_of(s.before, "before");
    d["after"] = picture_of(s.after, "after");
    d["difference"] = array_of(s.difference.difference);
    d["stderr"] = array_of(s.changes.deviation);
    d["probability"] = array_of(s.changes.probability);
  }
  d["written"] = list_of(s.written);
  return findings(d);
}

workflow::CompareJob job_of(const Call& call) {
  workflow::CompareJob job;
  call.apply(job);
  job.command_line = "semsurf.compare(...) in Python";
  if (!call.is_given("job.cache")) {
    const std::filesystem::path cache = io::cache_folder();
    job.model.folder = cache.empty() ? cache : cache / "models";
  }
  job.model.threads = job.threads;
  job.before = surface_of(call, "before", job.before_file);
  mc::Material material = material_of(call);
  const bool of_image = !material.name.empty() || !job.model.file.empty();
  if (of_image) {
    if (job.model.file.empty() && !call.is_given("beam.energy"))
      throw UsageError("`beam.energy`", "it is missing",
                       "Say what the SEM image was taken with, as `beam.energy=1keV`");
    if (!material.name.empty()) job.model.material = std::move(material);
    workflow::SemInput sem = sem_of(call, call["after"], "after");
    job.after = std::move(sem.image);
    job.after_file = sem.file;
  } else {
    workflow::ComparedSurface after = surface_of(call, "after", job.after_file);
    std::visit([&](auto& surface) { job.after = std::move(surface); }, after);
  }
  if (!job.folder.empty()) {
    require_file(job.before_file, "before");
    require_file(job.after_file, "after");
  }
  return job;
}

py::object compare(const Call& call) {
  const workflow::CompareJob job = job_of(call);
  workflow::CompareSummary s;
  call.work([&](const workflow::Reporter& reporter) { s = workflow::run(job, reporter); });
  for (const std::string& reason : s.reasons) Call::warn(reason);
  return found_of(s);
}

}  // namespace

void add_compare(py::module_& module) {
  Function f{.name = "compare",
             .summary = "Where a surface differs from another beyond their errors."};
  f.details =
      "Lays `after` on `before`. Where nothing changed, anything at all is listed in\n"
      "`false_alarms` of all comparisons. With `material` and `energy`, or `model`, `after` is an\n"
      "SEM image.";
  f.arguments = {{"before", "PathLike | HeightField | Mesh | ArrayLike",
                  "A scan, a surface, or a mesh of what is expected.", true, false},
                 {"after", "PathLike | HeightField | Mesh | Image | ArrayLike",
                  "A scan, a surface, a mesh or an SEM image of the later state.", true, false}};
  f.takes<workflow::CompareJob>()
      .takes<io::MaterialChoice>()
      .takes<io::SpecimenRequest>({}, all_but_units)
      .takes<io::HeightReadOptions>()
      .takes<io::SemReadOptions>();
  f.result_type = "Findings";
  f.result =
      "`verdict`, `places` that changed, strongest first, and arrays of `difference`, `stderr` "
      "and `probability`. `reasons` say why not to trust it.";
  f.example = ">>> semsurf.compare('monday.gwy', 'tuesday.gwy').places";
  define(module, f, compare);
}

}  // namespace surf::python
