// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/predict_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "common_parameters.h"
#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/overlaps.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mc/geometry/largest_length.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/step_record.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr double much = 0.001;  // share of the samples that justifies a warning

void check_outputs(const PredictJob& job, const Image& like) {
  if (job.outputs.empty()) return;
  std::vector<io::FileUse> outputs;
  for (const fs::path& output : job.outputs) outputs.push_back({"`output`", output, {}});
  io::refuse_overlaps({{"HEIGHTS", job.input, {}}, {"`prediction.model`", job.model, {}}}, outputs);
  for (const fs::path& output : job.outputs) {
    io::check_image_target(output, &like, {job.png_channel});
    io::check_writable(output);
  }
}

/// The job without the heights.
PredictJob parameters_of(const PredictJob& job) {
  PredictJob out;
  out.edge = job.edge;
  out.resample = job.resample;
  out.wanted = job.wanted;
  out.png_channel = job.png_channel;
  out.reading = job.reading;
  return out;
}

/// The name of the heights, for messages.
std::string name_of(const PredictJob& job) {
  return job.input.empty() ? "HEIGHTS" : job.input.string();
}

Image image_of(const PredictJob& job, const TrainedModel& model, const HeightField& field,
               const std::vector<std::string>& channels) {
  Image image;
  image.placement() = field.placement();
  for (const std::string& name : channels)
    image.channels.push_back({name, "1", Grid<float>(field.z_nm.width(), field.z_nm.height())});
  auto& made = image.metadata;
  std::vector<fs::path> inputs;
  if (!job.input.empty()) inputs.push_back(job.input);
  made = step_record("predict", record_of(parameters_of(job)), inputs);
  made["model"] =
      fmt::format("{} sha256 {}", job.model.filename().string(), io::sha256_of_file(job.model));
  made["model.kind"] = io::kind_of(model);
  if (!model.scope.material.empty()) made["material.1.name"] = model.scope.material;
  if (model.scope.energy_ev > 0) made["beam.energy_ev"] = format_exact(model.scope.energy_ev);
  made["beam.spot_nm"] = format_exact(model.scope.spot_nm);
  return image;
}

void fill(Image& image, const ModelImages& predicted) {
  for (std::size_t c = 0; c < predicted.size(); ++c)
    std::transform(predicted[c].data().begin(), predicted[c].data().end(),
                   image.channels[c].values.data().begin(),
                   [](double value) { return static_cast<float>(value); });
}

}  // namespace

std::vector<std::string> prediction_warnings(const TrainedModel& model, const HeightField& field) {
  std::vector<std::string> warnings;
  const double steepest = model.record.range.slope_deg_max;
  const double share = steepest > 0 ? share_steeper(field, steepest) : 0;
  if (share > much)
    warnings.push_back(fmt::format(
        "{} of the surface is steeper than the {:.0f} degrees that the model has learnt "
        "from at most: there its image is a guess. Train a model on such surfaces",
        format_share(std::round(1000 * share) / 1000), steepest));
  return warnings;
}

HeightField heights_for(const PredictJob& job, const ModelScope& scope) {
  const double pixel_nm = scope.pixel_nm;
  const bool other =
      pixel_nm > 0 && (job.field.pitch_x_nm != pixel_nm || job.field.pitch_y_nm != pixel_nm);
  return job.resample && other ? resampled(job.field, pixel_nm) : job.field;
}

void describe(ParameterVisitor& visit, PredictJob& job) {
  describe_path(visit, job.model,
                {.name = "prediction.model",
                 .help = "The model, as 'semsurf train' writes it",
                 .form = "FILE.json",
                 .recorded = false,
                 .file = FileRole::read});
  visit(job.edge, {"mirror", "flat", "periodic"},
        {.name = "prediction.edge",
         .help = "Continuation of the heights outside their samples",
         .otherwise = "mirror"});
  visit(job.resample, {.name = "prediction.resample",
                       .help = "Resample heights of another pitch to the model's pixels"});
  describe(visit, job.reading);
  visit(job.wanted.material, {.name = "specimen.material",
                              .help = "Material of the surface",
                              .otherwise = "as the model says",
                              .form = "MATERIAL"});
  std::optional<double> energy_ev =
      job.wanted.energy_ev > 0 ? std::optional(job.wanted.energy_ev) : std::nullopt;
  visit(energy_ev, {.name = "beam.energy",
                    .help = "Energy of the beam",
                    .unit = Unit::ev,
                    .limits = within(mc::min_beam_energy_ev, mc::max_beam_energy_ev),
                    .otherwise = "as the model says"});
  job.wanted.energy_ev = energy_ev.value_or(0);
  std::optional<double> spot_nm =
      job.wanted.spot_nm > 0 ? std::optional(job.wanted.spot_nm) : std::nullopt;
  visit(spot_nm, {.name = "beam.spot",
                  .help = "Standard deviation of the Gaussian spot",
                  .unit = Unit::nm,
                  .limits = within(0, mc::largest_length_nm),
                  .otherwise = "as the model says"});
  job.wanted.spot_nm = spot_nm.value_or(0);
  describe_images(visit, job.outputs, "Image to write: EXR, TIFF, PNG, VTI");
  visit(job.png_channel, {.name = "output.png_channel",
                          .help = "Channel that PNG files show",
                          .otherwise = "the model's first channel",
                          .form = "NAME"});
  describe_threads(visit, job.threads);
}

PredictSummary run(const PredictJob& job, const Reporter& reporter) {
  const Watch watch = reporter.watch();
  PredictSummary summary;
  check_parameters(parameters_of(job));
  if (job.model.empty())
    throw UsageError("`prediction.model`", "no model is given",
                     "Name one that 'semsurf train' has written");
  summary.model = io::read_model(job.model);
  const ModelScope& scope = summary.model.scope;
  check_conditions(scope, job.wanted);
  const auto model = make_model(summary.model);
  const HeightField field = heights_for(job, scope);
  if (field.pitch_x_nm != job.field.pitch_x_nm || field.pitch_y_nm != job.field.pitch_y_nm)
    reporter.note(fmt::format("{}: {} x {} samples of {} are resampled to {} x {} of {}",
                              name_of(job), job.field.z_nm.width(), job.field.z_nm.height(),
                              format_length(job.field.pitch_x_nm), field.z_nm.width(),
                              field.z_nm.height(), format_length(scope.pixel_nm)));
  check_field(scope, field, name_of(job).c_str());
  summary.image = image_of(job, summary.model, field, model->channels());
  check_outputs(job, summary.image);
  const auto start = std::chrono::steady_clock::now();
  fill(summary.image,
       model->predict(field, {.edge = job.edge, .threads = job.threads, .watch = watch}));
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  summary.range = surface_range(field);
  summary.warnings = prediction_warnings(summary.model, field);
  for (const std::string& warning : summary.warnings) reporter.warn(warning);
  watch.check();
  for (const fs::path& output : job.outputs)
    io::write_image(output, summary.image, {job.png_channel});
  return summary;
}

void take_scene(const std::filesystem::path& file, PredictJob& job) {
  const io::SceneFile scene = io::read_scene(file);
  const mc::Specimen& specimen = scene.specimen;
  if (!specimen.height_field || !specimen.bodies.empty())
    throw UsageError(file.string(), "its specimen is not a height field alone",
                     "Only a simulation can image it");
  if (scene.beam.tilt_deg != 0)
    throw UsageError(file.string(), "its beam is tilted",
                     "Models are for a beam from straight above: simulate it");
  job.field = specimen.height_field->field;
  job.edge = specimen.height_field->edge;
  job.wanted.material =
      specimen.materials.at(static_cast<std::size_t>(specimen.height_field->material)).name;
  job.wanted.energy_ev = scene.beam.energy_ev;
  job.wanted.spot_nm = scene.beam.spot_nm;
}

}  // namespace surf::workflow
