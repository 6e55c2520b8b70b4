// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/train_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "learners.h"
#include "sidecar.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/model/model_file.h"
#include "surf/io/overlaps.h"
#include "surf/mc/physics/material_doubts.h"
#include "surf/sem/fit_filter_bank.h"
#include "surf/workflow/step_record.h"
#include "training_data.h"

namespace surf::workflow {
namespace {

void check_numbers(const TrainJob& job, int own) {
  if (!(job.pixel_nm > 0 && std::isfinite(job.pixel_nm)))
    throw UsageError("`training.pixel_size`", "it must be above zero",
                     "Give the model's pixel size, as 3nm");
  mc::validate(job.physics, job.energy_ev);
  mc::validate(job.simulation.budget);
  std::vector<mc::Detector> detectors = mc::default_detectors();
  detectors.insert(detectors.end(), job.detectors.begin(), job.detectors.end());
  mc::validate(detectors);
  if (!job.detectors.empty() && !job.signal.empty())
    throw UsageError("`simulation.detectors`",
                     "an image of a microscope is one signal, whatever counted it",
                     "Leave one of the two out");
  const int surfaces = own + static_cast<int>(job.inputs.size());
  if (job.held_out < 0 || (job.held_out > 0 && job.held_out >= surfaces))
    throw UsageError(
        "`training.hold_out`",
        fmt::format("{} of {} surfaces leave none to learn on", job.held_out, surfaces),
        "Give fewer, or more surfaces");
  if (job.inputs.empty() && !job.signal.empty())
    throw UsageError("`training.signal`",
                     "an image is learnt together with the surface that it shows",
                     "Name its HEIGHTS");
  if (!job.signal.empty())
    for (const TrainingInput& input : job.inputs)
      if (!input.has_image())
        throw UsageError("`training.signal`", fmt::format("there is no image of {}", input.name),
                         "Give one for each of the HEIGHTS");
}

void check_target(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
                  bool is_shared) {
  io::check_model_target(job.output);
  std::vector<io::FileUse> inputs, outputs{{"`output`", job.output, {}}};
  for (const TrainingSurface& surface : surfaces) {
    if (!surface.image.empty()) inputs.push_back({"`training.images`", surface.image, {}});
    else if (!surface.has_image())
      outputs.push_back({"`output`", image_folder(job) / (surface.name + ".exr"), job.output});
  }
  if (is_shared) {
    const std::filesystem::path record = sidecar_path(job.output);
    outputs.push_back({"`output`", record, job.output});
    io::refuse_strangers(job.output, {record});
  }
  io::refuse_overlaps(inputs, outputs);
}

std::vector<TrainingImage> read_images(const TrainJob& job,
                                       const std::vector<TrainingSurface>& surfaces,
                                       const SimulatedImages& simulated) {
  std::vector<TrainingImage> images;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const auto& file = surfaces[i].has_image() ? surfaces[i].image : simulated.files[i];
    images.push_back(read_training_image(surfaces[i], file, job));
  }
  // Weights for only some of the images would mean nothing.
  if (std::any_of(images.begin(), images.end(),
                  [](const TrainingImage& i) { return i.standard_errors.empty(); }))
    for (TrainingImage& image : images) image.standard_errors.clear();
  return images;
}

std::map<std::string, std::string> notes_of(const TrainJob& job,
                                            const std::vector<TrainingSurface>& surfaces) {
  std::map<std::string, std::string> notes = step_record(training_command(job), record_of(job));
  for (const mc::Detector& d : job.detectors) {
    std::string& all = notes[detectors_note];
    all += (all.empty() ? "" : "; ") + mc::format_detector(d);
  }
  if (!surfaces.empty() && samples_per_pixel(job) > 1)
    notes["samples_per_pixel"] = std::to_string(samples_per_pixel(job));
  return notes;
}

/// Judges the finished model by images; the first belongs to surface `first`.
std::vector<TrainingScene> judge(const TrainJob& job, const ImageModel& model,
                                 const std::vector<TrainingSurface>& surfaces, std::size_t first,
                                 const std::vector<TrainingImage>& images, bool held_out) {
  std::vector<TrainingScene> scenes;
  for (std::size_t k = 0; k < images.size(); ++k) {
    const std::size_t i = first + k;
    TrainingScene scene;
    scene.name = surfaces[i].name;
    scene.sha256 = surfaces[i].sha256;
    scene.width = images[k].field.z_nm.width();
    scene.height = images[k].field.z_nm.height();
    const bool counted = !surfaces[i].has_image() && mc::electrons_of(job.simulation.budget) > 0;
    scene.electrons = counted ? mc::electrons_of(job.simulation.budget) : 0;
    scene.held_out = held_out;
    scene.residuals = residuals_of(model, {images[k]}, job.simulation.threads);
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

/// Completes the record of a finished model from its surfaces and images. Surfaces are in the order
/// of the images.
void complete_record(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
                     const std::vector<TrainingImage>& learnt,
                     const std::vector<TrainingImage>& held_out, TrainedModel& model) {
  TrainingRecord& record = model.record;
  for (const TrainingImage& image : learnt)
    record.range = united(record.range, surface_range(image.field));
  const auto usable = make_model(model);
  if (!learnt.empty()) record.residuals = residuals_of(*usable, learnt, job.simulation.threads);
  if (!held_out.empty())
    record.held_out_residuals = residuals_of(*usable, held_out, job.simulation.threads);
  record.scenes = judge(job, *usable, surfaces, 0, learnt, false);
  for (TrainingScene& scene : judge(job, *usable, surfaces, learnt.size(), held_out, true))
    record.scenes.push_back(std::move(scene));
}

/// Trains the model from the images and writes its file. `complete` is false if cancelled.
void learn(const TrainJob& job, const Learner& learner,
           const std::vector<TrainingSurface>& surfaces, const SimulatedImages& simulated,
           const Reporter& reporter, TrainSummary& summary) {
  std::vector<TrainingImage> images = read_images(job, surfaces, simulated);
  if (!images.empty()) validate(images);
  const std::size_t learnt =
      learner.needs_images ? images.size() - static_cast<std::size_t>(job.held_out) : 0;
  const auto split = images.begin() + static_cast<std::ptrdiff_t>(learnt);
  const std::vector<TrainingImage> held_out(split, images.end());
  images.erase(split, images.end());
  TrainedModel& model = summary.model;
  model.scope = {job.pixel_nm, job.material.name, job.energy_ev, job.spot_nm};
  try {
    Learnt result = learner.learn({job, model.scope, channels_of(job), images, reporter});
    model.parameters = std::move(result.parameters);
    model.record.condition_number = result.condition_number;
    model.record.warnings = std::move(result.warnings);
    model.record.notes = notes_of(job, surfaces);
    model.record.notes["model"] = learner.name;
    for (auto& [key, value] : result.notes) model.record.notes[key] = value;
  } catch (const Interrupted&) {
    summary.complete = false;
    return;
  }
  complete_record(job, surfaces, images, held_out, model);
  for (const std::string& warning : model.record.warnings) reporter.warn(warning);
  summary.complete = !reporter.cancelled();
  if (summary.complete) io::write_model(job.output, model);
}

}  // namespace

TrainSummary run(const TrainJob& job, const Reporter& reporter, Team* team) {
  const auto start = std::chrono::steady_clock::now();
  const Learner* learner = nullptr;
  std::vector<TrainingSurface> surfaces;
  together(team, [&] {
    learner = &learner_of(job);
    const int own = own_surfaces(job, learner->needs_images);
    check_numbers(job, own);
    surfaces = gather_surfaces(job, own, reporter.on_note);
    if (leads(team)) check_target(job, surfaces, team != nullptr);
  });
  if (leads(team))
    for (const std::string& doubt : mc::doubts(job.material)) reporter.warn(doubt);
  TrainSummary summary;
  const SimulatedImages simulated = simulate_images(job, surfaces, reporter, team);
  summary.images_found = simulated.found;
  summary.images_made = simulated.made;
  summary.complete = simulated.runs.complete;
  if (simulated.found + simulated.made > 0 || !summary.complete) summary.images = image_folder(job);
  if (!summary.complete) return summary;
  together(team, [&] {
    if (!leads(team)) return;
    learn(job, *learner, surfaces, simulated, reporter, summary);
    if (summary.complete) summary.written.push_back(job.output);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (!team || !summary.complete) return;
    summary.written.push_back(sidecar_path(job.output));
    io::write_text(summary.written.back(),
                   team_record(*team, simulated.runs, seconds.count(), job.simulation.threads,
                               training_command(job)));
  });
  return summary;
}

}  // namespace surf::workflow
