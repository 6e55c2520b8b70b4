// SPDX-License-Identifier: GPL-3.0-or-later
// Registration of an SEM image on a scan, and the surface that makes both most likely.
#include <fmt/format.h>

#include <algorithm>

#include "arrays.h"
#include "scan_findings.h"
#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/landmarks_file.h"
#include "surf/io/model/calibration_file.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/tip_job.h"

namespace surf::python {
namespace {

/// A tip, its file, or a shape as "cone:10nm,15deg".
Tip tip_for_scan(const Call& call, const workflow::AfmPreparationOptions& preparation,
                 const HeightField& scan) {
  const py::object given = call["tip"];
  if (!PyUnicode_Check(given.ptr())) return tip_of(given, "tip").tip;
  const auto text = given.cast<std::string>();
  const bool is_shape = std::ranges::any_of(
      std::initializer_list<const char*>{"parabola:", "cone:", "pyramid:", "ball:"},
      [&](const char* kind) { return text.starts_with(kind); });
  if (!is_shape) return tip_of(given, "tip").tip;
  const int shorter = std::min(scan.z_nm.width(), scan.z_nm.height());
  const int size = preparation.tip_size ? preparation.tip_size : std::min(41, shorter / 2 * 2 - 1);
  return workflow::tip_by_shape(
      {workflow::parse_tip_shape(text, "tip"), size, scan.pitch_x_nm, scan.pitch_y_nm}, "tip");
}

void take_afm(const Call& call, workflow::AfmInput& afm) {
  workflow::AfmPreparationOptions& p = afm.preparation;
  if (call.is_given("level.degree") && p.level.method != workflow::LevelMethod::polynomial)
    throw UsageError("`level.degree`", "only a polynomial has one",
                     "Add `level.method=polynomial`");
  const Heights heights = heights_of(call["afm"], afm.reading, "afm");
  afm.scan = heights.field;
  afm.file = heights.file;
  if (call.has("tip")) p.tip = tip_for_scan(call, p, afm.scan);
}

void take_model(const Call& call, int threads, workflow::ModelRequest& model) {
  mc::Material material = material_of(call);
  const bool named = !material.name.empty();
  if (named) model.material = std::move(material);
  if (model.file.empty() && !named)
    throw UsageError("`specimen.material`", "it is missing, and so is `reconstruction.model`",
                     "Say what the specimen is made of, as `specimen.material=Si`");
  if (model.file.empty() && !call.is_given("beam.energy"))
    throw UsageError("`beam.energy`", "it is missing",
                     "Say what the SEM image was taken with, as `beam.energy=1keV`");
  if (!call.is_given("job.cache")) {
    const std::filesystem::path cache = io::cache_folder();
    model.folder = cache.empty() ? cache : cache / "models";
  }
  model.threads = threads;
}

std::vector<LandmarkPair> landmarks_of(py::handle given, const PlacedImage& sem,
                                       const HeightField& afm) {
  if (is_path(given))
    return io::read_landmarks(path_of(given), sem, {afm.placement(), afm.z_nm, afm.valid});
  const Grid<double> rows = grid_of<double>(given, "landmarks");
  if (rows.width() != 4)
    throw InvalidInput("landmarks", fmt::format("the array has {} columns", rows.width()),
                       "Give rows of x and y in the SEM image, then x and y in the scan, in nm");
  std::vector<LandmarkPair> pairs;
  for (int i = 0; i < rows.height(); ++i)
    pairs.push_back({{rows(0, i), rows(1, i)}, {rows(2, i), rows(3, i)}});
  return pairs;
}

void take_pose(const Call& call, const HeightField& afm, const PlacedImage& sem,
               workflow::PoseOptions& pose) {
  if (pose.transform && call.has("landmarks"))
    throw UsageError("`registration.transform`", "landmarks are given, too",
                     "Leave out one of the two");
  if (!pose.transform_doubt.empty() && !pose.accept_unverified)
    throw UsageError("`registration.transform`",
                     fmt::format("its registration is not verified ({})", pose.transform_doubt),
                     "`registration.accept_registration` takes it all the same");
  if (pose.landmarks_only && !call.has("landmarks"))
    throw UsageError("`registration.landmarks_only`", "there are no landmarks",
                     "Give landmarks, or leave it out");
  if (!call.has("landmarks")) return;
  pose.landmarks = landmarks_of(call["landmarks"], sem, afm);
  fit_landmarks(pose.landmarks);  // complains of too few, or on a line, before any work
}

py::object heights_object(HeightField field) {
  Heights made;
  made.field = std::move(field);
  return object_of(std::move(made));
}

py::object tip_object(Tip tip) {
  TipShape made;
  made.tip = std::move(tip);
  return object_of(std::move(made));
}

void add_pose(const workflow::Pose& pose, py::dict& d) {
  if (pose.registration)
    for (const auto& [key, value] : found_of(*pose.registration)) d[key] = value;
  d["transform"] = matrix_of(pose.sem_to_afm);
  d["verified"] = pose.verified();
  if (!pose.simulated.values.empty()) d["simulated"] = picture_of(pose.simulated, "simulated");
  py::list places;
  for (const workflow::JudgedPlace& place : pose.places) {
    py::dict one;
    one["transform"] = matrix_of(place.sem_to_afm);
    one["probability"] = place.probability;
    one["explained"] = place.explained;
    places.append(findings(one));
  }
  d["places"] = places;
}

py::object register_images(const Call& call) {
  workflow::RegisterJob job;
  call.apply(job);
  take_model(call, job.threads, job.model);
  take_afm(call, job.afm);
  std::vector<workflow::SemInput> images = sems_of(call, "sem");
  if (images.size() != 1)
    throw UsageError("sem", fmt::format("{} SEM images are given", images.size()),
                     "Register the one that looks straight down");
  job.sem = std::move(images.front());
  if (!job.transform.empty() || !job.picture.empty())
    require_file(job.afm.file, "afm"), require_file(job.sem.file, "sem");
  take_pose(call, job.afm.scan, job.sem.image, job.pose);
  workflow::RegisterSummary s;
  call.work([&](const workflow::Reporter& reporter) { s = workflow::run(job, reporter); });
  py::dict d;
  add_pose(s.pose, d);
  d["tip"] = tip_object(s.afm.tip);
  d["eroded"] = heights_object(s.afm.eroded());
  d["model"] = s.model.file.string();
  return findings(d);
}

/// With a part for each image, so that all can be described.
workflow::ReconstructJob whole_job() {
  workflow::ReconstructJob job;
  job.afm.emplace();
  job.sem.emplace();
  return job;
}

workflow::ReconstructJob reconstruct_job(const Call& call) {
  workflow::ReconstructJob job = whole_job();
  call.apply(job);
  if (!call.has("afm") && !call.has("sem"))
    throw UsageError("reconstruct", "neither a scan nor an SEM image is given",
                     "Give afm, sem, or both");
  if (!call.has("afm")) job.afm.reset();
  if (!call.has("sem")) job.sem.reset();
  if (call.has("calibration")) {
    if (job.calibration)
      throw UsageError("calibration", "gains or an offset are given, too", "Leave one of them out");
    const Calibration c = io::read_calibration(path_of(call["calibration"])).calibration;
    job.calibration = {c.gains, c.offset};
  }
  if (job.refine_tip == true && job.options.method != ReconstructionMethod::gauss_newton)
    throw UsageError("`reconstruction.refine_tip`", "only Gauss-Newton fits the tip",
                     "Leave out `reconstruction.optimiser`, or this");
  if (job.sem) take_model(call, job.options.threads, job.model);
  job.material_files = call.told<io::MaterialChoice>().files;
  if (job.afm) take_afm(call, *job.afm);
  if (job.sem) {
    std::vector<workflow::SemInput> images = sems_of(call, "sem");
    job.sem = std::move(images.front());
    images.erase(images.begin());
    job.views = std::move(images);
  }
  if (job.afm && job.sem) take_pose(call, job.afm->scan, job.sem->image, job.pose);
  if (call.has("truth")) {
    const Heights truth = heights_of(call["truth"], {}, "truth");
    job.truth = truth.field;
    job.truth_file = truth.file;
  }
  if (!job.folder.empty()) {
    if (job.afm) require_file(job.afm->file, "afm");
    if (job.sem) require_file(job.sem->file, "sem");
    for (const workflow::SemInput& view : job.views) require_file(view.file, "sem");
    if (job.truth) require_file(job.truth_file, "truth");
  }
  job.command_line = "semsurf.reconstruct(...) in Python";
  return job;
}

py::list texts(const std::vector<std::string>& lines) {
  py::list list;
  for (const std::string& line : lines) list.append(with_keywords(line));
  return list;
}

void add_surface(Reconstruction& r, py::dict& d) {
  const Placement placement = r.surface.placement();
  if (!r.deviation_nm.empty()) d["stderr"] = array_of(std::move(r.deviation_nm));
  if (!r.lower_nm.empty()) {
    d["lower"] = array_of(std::move(r.lower_nm));
    d["upper"] = array_of(std::move(r.upper_nm));
  }
  if (!r.data_support.empty()) d["held_by"] = array_of(std::move(r.data_support));
  if (!r.simulated_sem.empty())
    d["simulated_sem"] = picture_of(std::move(r.simulated_sem), placement, "simulated");
  if (!r.simulated_afm.z_nm.empty()) d["simulated_afm"] = heights_object(r.simulated_afm);
  if (!r.tip.z_nm.empty()) d["tip"] = tip_object(r.tip);
  d["start"] = heights_object(r.start);
  d["gains"] = array_of(r.gains);
  d["offset"] = r.offset;
  d["converged"] = r.converged;
  d["transform"] = matrix_of(r.sem_to_afm);
  d["surface"] = heights_object(std::move(r.surface));
}

py::object found_of(const workflow::TruthReport& truth) {
  py::dict d;
  d["rms_nm"] = truth.rms_nm;
  d["start_rms_nm"] = truth.start_rms_nm;
  d["offset_nm"] = truth.offset_nm;
  d["coverage_1"] = truth.coverage_1;
  d["coverage_2"] = truth.coverage_2;
  d["in_interval"] = truth.in_interval;
  return findings(d);
}

py::object reconstruct(const Call& call) {
  const workflow::ReconstructJob job = reconstruct_job(call);
  workflow::ReconstructSummary s;
  call.work([&](const workflow::Reporter& reporter) { s = workflow::run(job, reporter); });
  for (const std::string& reason : s.reasons) Call::warn(reason);
  py::dict d;
  d["verdict"] = workflow::name(s.verdict);
  d["reasons"] = texts(s.reasons);
  d["warnings"] = texts(s.warnings);
  d["surface"] = py::none();
  if (s.pose) {
    py::dict pose;
    add_pose(*s.pose, pose);
    d["registration"] = findings(pose);
  }
  if (s.sem_noise) {
    py::dict noise;
    noise["slope"] = s.sem_noise->slope;
    noise["intercept"] = s.sem_noise->intercept;
    d["sem_noise"] = findings(noise);
  }
  if (s.verdict != workflow::ReconstructionVerdict::not_registered) add_surface(s.result, d);
  d["held"] = texts(s.held);
  if (s.truth) d["truth"] = found_of(*s.truth);
  py::list written;
  for (const auto& file : s.written) written.append(file.string());
  d["written"] = written;
  return findings(d);
}

const Argument afm{"afm", "PathLike | HeightField | ArrayLike",
                   "The AFM scan, of any format; arrays are in nm.", true, false};
const Argument sem{"sem", "PathLike | Image | ArrayLike", "The SEM image.", true, false};
const Argument tip{"tip", "PathLike | Tip | str",
                   "The tip, or its shape as 'cone:10nm,15deg'; found blindly if not given."};
const Argument landmarks{"landmarks", "PathLike | ArrayLike",
                         "Places seen in both images, to start from: a file, or rows of x and y in "
                         "the SEM image and x and y in the scan, in nm."};

}  // namespace

void add_chain(py::module_& module) {
  Function r{.name = "register",
             .summary = "Lay an SEM image on an AFM scan of the same place.",
             .arguments = {afm, sem, tip, landmarks}};
  r.takes<io::MaterialChoice>().takes<workflow::RegisterJob>(
      {}, {"registration.transform", "registration.accept_registration"});
  r.result_type = "Findings";
  r.result =
      "`transform`, the 2 x 3 matrix from the SEM image to the scan in nm, with "
      "`transform_stderr`; `verdict`, `verified`, `reason`, `rivals`; the `tip`, the `eroded` scan "
      "and the `simulated` image.";
  define(module, r, register_images);

  Argument scan = afm, images = sem;
  scan.required = images.required = false;
  images.type = "PathLike | Image | ArrayLike | Sequence";
  images.help = "The SEM image; further ones of a list are of the same place from other sides.";
  Function f{.name = "reconstruct",
             .summary = "The surface that makes an AFM scan and an SEM image most likely.",
             .arguments = {scan, images, tip, landmarks}};
  f.arguments.push_back(
      {"calibration", "PathLike", "Gains and offset, as 'semsurf calibrate' writes them."});
  f.arguments.push_back({"truth", "PathLike | HeightField | ArrayLike",
                         "Heights in the SEM's frame, to compare the result with."});
  f.takes<io::MaterialChoice>().takes(whole_job());
  f.result_type = "Findings";
  f.result =
      "`surface` (None if the images seem unrelated) with the standard deviation of each height "
      "`stderr`, `verdict` and its `reasons`, `registration`, `tip`, what the images look like by "
      "the surface, gains and offset.";
  define(module, f, reconstruct);
}

}  // namespace surf::python
