// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/train_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "learners.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/model_file.h"
#include "surf/sem/model_residual.h"
#include "surf/workflow/version.h"
#include "training_data.h"

namespace surf::workflow {
namespace {

void check_numbers(const TrainJob& job) {
  if (!(job.pixel_nm > 0 && std::isfinite(job.pixel_nm)))
    throw UsageError("--pixel-size", "it must be above zero", "Give the model's pixel size, as 3nm");
  const int surfaces = job.inputs.empty() ? job.surfaces : static_cast<int>(job.inputs.size());
  if (job.held_out < 0 || job.held_out >= surfaces)
    throw UsageError("--hold-out", fmt::format("{} of {} surfaces leave none to learn on", job.held_out, surfaces),
                     "Give fewer, or more surfaces");
  if (job.inputs.empty() && !job.signal.empty())
    throw UsageError("--signal", "an image is learnt together with the surface that it shows", "Name its HEIGHTS");
  if (!job.signal.empty())
    for (const TrainingInput& input : job.inputs)
      if (input.image.empty())
        throw UsageError("--signal", fmt::format("there is no image of {}", input.name), "Give one for each of the HEIGHTS");
}

void check_target(const TrainJob& job, const std::vector<TrainingSurface>& surfaces) {
  io::check_model_target(job.output);
  std::error_code ignored;
  for (const TrainingSurface& surface : surfaces)
    if (!surface.image.empty() && std::filesystem::equivalent(surface.image, job.output, ignored))
      throw UsageError("--output", fmt::format("{} is an input", job.output.string()), "Choose another name");
}

std::vector<TrainingImage> read_images(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
                                       const SimulatedImages& simulated) {
  std::vector<TrainingImage> images;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const auto& file = surfaces[i].image.empty() ? simulated.files[i] : surfaces[i].image;
    images.push_back(read_training_image(surfaces[i], file, job));
  }
  // Weights of some images beside none of others would mean nothing.
  if (std::any_of(images.begin(), images.end(), [](const TrainingImage& i) { return i.standard_errors.empty(); }))
    for (TrainingImage& image : images) image.standard_errors.clear();
  return images;
}

std::map<std::string, std::string> notes_of(const TrainJob& job) {
  std::map<std::string, std::string> notes{{"semsurf.version", version()}};
  if (!job.command_line.empty()) notes["command"] = job.command_line;
  notes["edge"] = job.edge == Edge::mirror ? "mirror" : job.edge == Edge::flat ? "flat" : "periodic";
  const bool all_given = !job.inputs.empty() && std::all_of(job.inputs.begin(), job.inputs.end(), [](const auto& input) {
    return !input.image.empty();
  });
  if (job.inputs.empty()) notes["surfaces"] = fmt::format("semsurf's own, {} pixels across", job.surface_px);
  if (all_given) return notes;
  notes["physics"] = mc::format_physics(job.physics);
  notes["seed"] = std::to_string(job.simulation.seed);
  if (job.simulation.accuracy > 0) notes["accuracy"] = format_exact(job.simulation.accuracy);
  else notes["electrons"] = std::to_string(job.simulation.electrons);
  return notes;
}

/// What the finished model makes of every surface.
void judge_all(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
               const std::vector<TrainingImage>& images, std::size_t learnt, TrainedModel& model) {
  const auto usable = make_model(model);
  ResidualSum on_learnt(usable->channels()), on_held_out(usable->channels());
  for (std::size_t i = 0; i < images.size(); ++i) {
    const bool held_out = i >= learnt;
    const ModelImages predicted = usable->predict(images[i].field, {images[i].edge, job.simulation.threads});
    ResidualSum alone(usable->channels());
    alone.add(predicted, images[i]);
    (held_out ? on_held_out : on_learnt).add(predicted, images[i]);
    TrainingScene scene;
    scene.name = surfaces[i].name;
    scene.sha256 = surfaces[i].sha256;
    scene.width = images[i].field.z_nm.width();
    scene.height = images[i].field.z_nm.height();
    const bool counted = surfaces[i].image.empty() && !(job.simulation.accuracy > 0);
    scene.electrons = counted ? job.simulation.electrons : 0;
    scene.held_out = held_out;
    scene.residuals = alone.residuals();
    model.record.scenes.push_back(std::move(scene));
    if (!held_out) model.record.range = united(model.record.range, surface_range(images[i].field));
  }
  model.record.residuals = on_learnt.residuals();
  if (learnt < images.size()) model.record.held_out_residuals = on_held_out.residuals();
}

}  // namespace

TrainSummary run(const TrainJob& job, const TrainListener& listener) {
  const Learner& learner = learner_of(job.learn);
  check_numbers(job);
  const std::vector<TrainingSurface> surfaces = gather_surfaces(job, listener.note);
  check_target(job, surfaces);
  TrainSummary summary;
  const SimulatedImages simulated = simulate_images(job, surfaces, listener);
  summary.images_found = simulated.found;
  summary.images_made = simulated.made;
  summary.complete = simulated.complete;
  if (simulated.found + simulated.made > 0 || !simulated.complete) summary.images = image_folder(job);
  if (!summary.complete) return summary;

  std::vector<TrainingImage> images = read_images(job, surfaces, simulated);
  validate(images);
  const std::size_t learnt = images.size() - static_cast<std::size_t>(job.held_out);
  const std::vector<TrainingImage> lessons(images.begin(), images.begin() + static_cast<std::ptrdiff_t>(learnt));
  TrainedModel& model = summary.model;
  model.scope = {job.pixel_nm, job.material.name, job.energy_ev, job.spot_nm};
  Learnt result = learner.learn({job, model.scope, channels_of(job), lessons, listener});
  model.parameters = std::move(result.parameters);
  model.record.condition_number = result.condition_number;
  model.record.warnings = std::move(result.warnings);
  model.record.notes = notes_of(job);
  model.record.notes["model"] = learner.name;
  for (auto& [key, value] : result.notes) model.record.notes[key] = value;
  judge_all(job, surfaces, images, learnt, model);
  for (const std::string& warning : model.record.warnings)
    if (listener.warn) listener.warn(warning);
  if (listener.cancel && listener.cancel->cancelled()) {
    summary.complete = false;
    return summary;
  }
  io::write_model(job.output, model);
  return summary;
}

}  // namespace surf::workflow
