// SPDX-License-Identifier: GPL-3.0-or-later
// Fast models: training and predictions; guided estimates of simulated images.
#include <fmt/format.h>

#include "arrays.h"
#include "data.h"
#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/model/model_file.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/scene_file.h"
#include "surf/workflow/estimate_job.h"
#include "surf/workflow/predict_job.h"
#include "surf/workflow/train_job.h"

namespace surf::python {
namespace {

py::object found_of(const ModelScope& scope) {
  py::dict d;
  d["material"] = scope.material;
  d["energy_ev"] = scope.energy_ev;
  d["spot_nm"] = scope.spot_nm;
  d["pixel_nm"] = scope.pixel_nm;
  return findings(d);
}

py::object predict(const Call& call) {
  workflow::PredictJob job;
  call.apply(job);
  if (job.model.empty())
    throw UsageError("`prediction.model`", "no model is given",
                     "Add `prediction.model=MODEL.json`; semsurf.train makes one");
  if (is_path(call["heights"]) && io::is_scene_file(path_of(call["heights"]))) {
    job.input = path_of(call["heights"]);
    for (const char* name : {"scan.height_channel", "scan.height_unit", "scan.height_pitch"})
      if (call.is_given(name))
        throw UsageError(fmt::format("`{}`", name), "a scene file says this itself",
                         "Change the scene file");
    workflow::take_scene(job.input, job);
    call.apply(job);  // goes before what a scene file says
  } else {
    const Heights heights = heights_of(call, "heights");
    job.field = heights.field;
    job.input = heights.file;
    job.reading = heights.reading;
  }
  workflow::PredictSummary s;
  call.work([&](const workflow::Reporter& reporter) { s = workflow::run(job, reporter); });
  Picture made;
  made.image = std::move(s.image);
  made.record = made.image.metadata;
  py::dict found;
  found["scope"] = found_of(s.model.scope);
  found["seconds"] = s.seconds;
  found["slope_deg_max"] = s.range.slope_deg_max;
  made.found = findings(found);
  return object_of(std::move(made));
}

py::object estimate(const Call& call) {
  workflow::EstimateJob job;
  call.apply(job);
  if (is_path(call["image"])) {
    job.input = path_of(call["image"]);
  } else {
    Picture given = picture_of(call["image"], "image");
    job.image = std::move(given.image);
    job.image.metadata = given.record;
  }
  workflow::EstimateSummary s;
  call.work([&](const workflow::Reporter& reporter) { s = workflow::run(job, reporter); });
  Picture made;
  made.image = std::move(s.image);
  made.record = made.image.metadata;
  py::dict found, gains;
  for (std::size_t d = 0; d < s.gains.size(); ++d) {
    py::dict gain;
    gain["error_share"] = s.gains[d].error_share;
    gain["plain_share"] = s.gains[d].plain_share;
    gain["electrons"] = s.gains[d].electrons();
    gains[py::str(s.detectors[d])] = findings(gain);
  }
  found["gains"] = findings(gains);
  py::list guides;
  for (const std::string& guide : s.guides) guides.append(guide);
  found["guides"] = guides;
  made.found = findings(found);
  return object_of(std::move(made));
}

std::vector<py::object> list_of(const py::object& value) {
  if (value.is_none()) return {};
  if (!PyList_Check(value.ptr()) && !PyTuple_Check(value.ptr())) return {value};
  std::vector<py::object> all;
  for (const py::handle one : value) all.push_back(py::reinterpret_borrow<py::object>(one));
  return all;
}

void add_surfaces(const Call& call, workflow::TrainJob& job) {
  for (const py::object& one : list_of(call["heights"])) {
    const Heights heights = heights_of(one, job.reading, "heights");
    const bool is_file = !heights.file.empty();
    job.inputs.push_back({is_file ? heights.file.string() : "heights",
                          heights.field,
                          is_file ? io::sha256_of_file(heights.file) : std::string(),
                          {}});
  }
  if (job.inputs.empty()) {
    for (const char* name : {"images", "signal"})
      if (call.has(name))
        throw UsageError(name, "no heights are given", "Give the surfaces, or leave it out");
    if (job.pixel_nm == 0)
      throw UsageError("`training.pixel_size`", "it is missing",
                       "Say how large the pixels of your images are, as 3nm");
    return;
  }
  for (const char* name : {"training.surfaces", "training.surface_size"})
    if (call.is_given(name))
      throw UsageError(fmt::format("`{}`", name),
                       "it is about semsurf's own surfaces, and heights are given", "Leave it out");
  if (job.pixel_nm > 0) return;
  const HeightField& first = job.inputs.front().field;
  if (first.pitch_x_nm != first.pitch_y_nm)
    throw UsageError("`training.pixel_size`", "the samples of heights are not square",
                     "Say how large the model's pixels are, as 3nm");
  job.pixel_nm = first.pitch_x_nm;
}

/// `images` have SE and BSE, `signal` is a microscope's: its first channel.
void add_images(const Call& call, workflow::TrainJob& job) {
  if (call.has("images") && call.has("signal"))
    throw UsageError("signal", "images are given too", "Leave one of them out");
  const char* const argument = call.has("signal") ? "signal" : "images";
  const std::vector<py::object> images = list_of(call[argument]);
  if (images.empty()) return;
  if (images.size() != job.inputs.size())
    throw UsageError(
        argument,
        fmt::format("{} images are given for {} surfaces", images.size(), job.inputs.size()),
        "Give one for each, in the same order");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Picture picture = picture_of(images[i], argument);
    if (call.has("signal")) {
      const std::string& name = picture.image.channels.front().name;
      if (i > 0 && name != job.signal)
        throw UsageError("signal",
                         fmt::format("channel '{}' here and '{}' before", name, job.signal),
                         "Give images of the same channel");
      job.signal = name;
    }
    if (!picture.file.empty()) job.inputs[i].image = picture.file;
    else job.inputs[i].pixels = std::make_shared<Image>(picture.image);
  }
}

py::object found_of(const std::vector<ModelResidual>& residuals) {
  py::dict channels;
  for (const ModelResidual& r : residuals) {
    py::dict d;
    d["rms"] = r.rms;
    d["rms_share"] = r.mean_signal > 0 ? r.rms / r.mean_signal : 0;
    d["mean_relative"] = r.mean_relative;
    d["mean_signal"] = r.mean_signal;
    channels[py::str(r.channel)] = findings(d);
  }
  return findings(channels);
}

py::object found_of(const workflow::TrainJob& job, const workflow::TrainSummary& s) {
  py::dict d;
  d["file"] = job.output.string();
  d["kind"] = io::kind_of(s.model);
  d["scope"] = found_of(s.model.scope);
  py::list channels;
  const auto model = make_model(s.model);  // outlives its names
  for (const std::string& name : model->channels()) channels.append(name);
  d["channels"] = channels;
  d["residuals"] = found_of(s.model.record.residuals);
  d["held_out_residuals"] = found_of(s.model.record.held_out_residuals);
  d["images_made"] = s.images_made;
  d["images_found"] = s.images_found;
  d["images"] = s.images.string();
  d["record"] = record_of(s.model.record.notes);
  return findings(d);
}

py::object train(const Call& call) {
  workflow::TrainJob job;
  call.apply(job);
  if (job.output.empty())
    throw UsageError("`output`", "no file for the model is given", "Add `output=model.json`");
  io::check_model_target(job.output);
  check_parameters(job);
  const auto choice = call.told<io::MaterialChoice>();
  job.material_files.assign(choice.files.begin(), choice.files.end());
  job.material = material_of(call);
  if (job.material.name.empty()) {
    job.material = io::find_material("Si", "`specimen.material`");
    Call::note("no `specimen.material` is given: Si is assumed");
  }
  add_surfaces(call, job);
  add_images(call, job);
  workflow::TrainSummary summary;
  call.work([&](const workflow::Reporter& reporter) {
    summary = workflow::run(job, reporter);
    if (!summary.complete) throw Interrupted();
  });
  return found_of(job, summary);
}

const Argument heights_argument{"heights", "PathLike | HeightField | ArrayLike",
                                "A scan or an image of heights; arrays are in nm.", true, false};

}  // namespace

void add_models(py::module_& module) {
  Function f{.name = "predict",
             .summary = "An SEM image of heights by a fast model, in place of a simulation.",
             .arguments = {heights_argument}};
  f.arguments[0].help += " Or a scene file (TOML) of one height field.";
  f.result_type = "Image";
  f.result = "The model's channels, in counts per primary.";
  f.example = ">>> image = semsurf.predict('scan.gwy', model='si-1keV-3nm.json')";
  define(module, f.takes<workflow::PredictJob>(), predict);

  Function e{
      .name = "estimate",
      .summary = "A simulated image of few electrons, estimated with the help of neighbours."};
  e.arguments = {{"image", "PathLike | Image",
                  "An image with counts, as simulate(..., channels=['counts', 'electrons', "
                  "'z_nm', 'normal', 'material']) makes it.",
                  true, false}};
  e.result_type = "Image";
  e.result =
      "The image with its detectors' channels estimated anew; their standard errors include the "
      "bias. `found` has the gains.";
  define(module, e.takes<workflow::EstimateJob>(), estimate);

  Function t{.name = "train",
             .summary = "Train a fast model of SEM images, on simulated or real ones."};
  t.details =
      "Without heights the model learns on surfaces of semsurf's own. Without images they are\n"
      "simulated, into NAME.training beside NAME.json; the same call goes on from there.";
  t.arguments = {{"heights", "PathLike | HeightField | ArrayLike | Sequence",
                  "Surfaces to learn on; semsurf's own if there are none.", false, false},
                 {"images", "PathLike | Image | Sequence",
                  "An image with SE and BSE for each of the surfaces."},
                 {"signal", "PathLike | Image | Sequence",
                  "A microscope's image for each of the surfaces, pixel on sample: the model then "
                  "has its one signal."}};
  t.takes<io::MaterialChoice>().takes<workflow::TrainJob>();
  t.result_type = "Findings";
  t.result =
      "`file`, `kind`, `scope`, and how far the model is off: `residuals`, `held_out_residuals`.";
  define(module, t, train);
}

}  // namespace surf::python
