// SPDX-License-Identifier: GPL-3.0-or-later
// Lines, trenches and holes in an SEM image.
#include <fmt/format.h>

#include "arrays.h"
#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/profile_job.h"

namespace surf::python {
namespace {

py::object found_of(const Measured& m) { return measured(m.value, m.standard_error); }

py::list found_of(const std::vector<Measured>& all) {
  py::list list;
  for (const Measured& one : all) list.append(found_of(one));
  return list;
}

py::object wall(const std::array<Measured, profile_numbers>& numbers) {
  py::dict d;
  d["width_nm"] = found_of(numbers[profile_width]);
  d["height_nm"] = found_of(numbers[profile_height]);
  d["angle_deg"] = found_of(numbers[profile_angle]);
  d["top_radius_nm"] = found_of(numbers[profile_top]);
  d["foot_radius_nm"] = found_of(numbers[profile_foot]);
  return findings(d);
}

py::object found_of(const EdgeRoughness& r) {
  py::dict d;
  d["found"] = r.found;
  d["sigma_nm"] = r.sigma_nm;
  d["sigma_stderr_nm"] = r.sigma_error_nm;
  d["correlation_nm"] = r.correlation_nm;
  d["hurst"] = r.hurst;
  d["noise_nm"] = r.noise_nm;
  d["biased_sigma_nm"] = r.biased_sigma_nm;
  return findings(d);
}

py::list edges_of(const ProfileFit& fit) {
  py::list list;
  for (const FittedEdge& edge : fit.edges()) {
    py::dict d;
    d["place_nm"] = found_of(edge.place_nm);
    d["feature"] = edge.edge.feature;
    d["material_right"] = edge.edge.material_right;
    d["rows_nm"] = array_of(edge.rows_nm);
    d["rows_stderr_nm"] = array_of(edge.errors_nm);
    list.append(findings(d));
  }
  return list;
}

workflow::ProfileJob job_of(const Call& call) {
  workflow::ProfileJob job;
  job.cache = io::cache_folder("");
  call.apply(job);
  if (mc::Material material = material_of(call); !material.name.empty())
    job.material = std::move(material);
  if (!call.is_given("beam.energy"))
    throw UsageError("`beam.energy`", "it is missing",
                     "Say what the image was taken with, as `beam.energy=1keV`");
  const io::SemReadOptions reading = job.sem.reading;
  job.sem = sem_of(call, call["image"], "image");
  job.sem.reading = reading;
  job.views = sems_of(call, "sem");
  if (call.has("afm")) {
    const Heights scan = heights_of(call["afm"], {}, "afm");
    job.scan = scan.field;
    job.scan_file = scan.file;
  }
  if (!job.folder.empty()) {
    require_file(job.sem.file, "image");
    for (const workflow::SemInput& view : job.views) require_file(view.file, "sem");
    if (job.scan) require_file(job.scan_file, "afm");
  }
  job.command_line = "semsurf.profile(...) in Python";
  return job;
}

py::object profile(const Call& call) {
  const workflow::ProfileJob job = job_of(call);
  workflow::ProfileSummary s;
  call.work([&](const workflow::Reporter& reporter) { s = workflow::run(job, reporter); });
  for (const std::string& reason : s.reasons) Call::warn(reason);
  py::dict d;
  d["left"] = wall(s.fit.left);
  d["right"] = wall(s.fit.right);
  d["widths_nm"] = found_of(s.fit.widths_nm);
  d["threshold_widths_nm"] = found_of(s.threshold_widths_nm);
  if (s.measured_pitch_nm) d["pitch_nm"] = found_of(*s.measured_pitch_nm);
  if (s.scan_height_nm) d["scan_height_nm"] = found_of(*s.scan_height_nm);
  d["edges"] = edges_of(s.fit);
  d["edge_roughness"] = found_of(s.fit.edge_roughness);
  d["width_roughness"] = found_of(s.fit.width_roughness);
  d["discrepancy_share"] = s.discrepancy_share;
  d["simulated"] = s.simulated;
  py::list reasons, written;
  for (const std::string& reason : s.reasons) reasons.append(with_keywords(reason));
  for (const auto& file : s.written) written.append(file.string());
  d["reasons"] = reasons;
  d["written"] = written;
  Heights surface;
  surface.field = std::move(s.surface);
  d["surface"] = object_of(std::move(surface));
  d["stderr"] = array_of(std::move(s.deviation_nm));
  d["fitted"] = picture_of(std::move(s.fitted), job.sem.image.placement(), "fitted");
  return findings(d);
}

}  // namespace

void add_profile(py::module_& module) {
  Function f{.name = "profile",
             .summary = "Widths, wall angles and edge roughness of lines, trenches and holes."};
  f.details =
      "Profiles of such shapes are simulated and compared with the image. Lines run along y, or\n"
      "along x with `along_x`. How high walls are no upright view shows: give `height`, a scan\n"
      "(`afm`), or further images from other sides (`sem`, `tilt`).";
  f.arguments = {{"image", sem_type, "The SEM image.", true, false},
                 {"sem", "PathLike | Image | ArrayLike | Sequence",
                  "Further SEM images of such features, from other sides or by other detectors."},
                 {"afm", "PathLike | HeightField | ArrayLike",
                  "An AFM scan that shows how high walls are, levelled."}};
  f.takes<io::MaterialChoice>().takes<workflow::ProfileJob>();
  f.result_type = "Findings";
  f.result =
      "Shapes of `left` and `right` walls, `widths_nm`, `edges` with the place of each row, "
      "roughness; each number as `value` and `stderr`. `reasons` say why not to trust it.";
  define(module, f, profile);
}

}  // namespace surf::python
