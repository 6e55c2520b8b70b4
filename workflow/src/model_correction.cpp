// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_correction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/workflow/simulate_job.h"
#include "training_data.h"

namespace surf::workflow {
namespace {

bool has_channel(const StoredModel& model, const std::string& name) {
  return std::ranges::find(model.model->channels(), name) != model.model->channels().end();
}

SimulateJob simulation_of(const HeightField& surface, const PlacedImage& sem,
                          const StoredModel& model, const CorrectionRequest& request) {
  const ModelScope& scope = model.trained.scope;
  SimulateJob job;
  io::SceneFile& scene = job.scene;
  scene.specimen.materials = {request.material};
  const int fine = samples_per_pixel(request.material, scope.energy_ev, sem.pitch_x_nm);
  scene.specimen.height_field =
      mc::HeightFieldBody{"surface", smoothly_upsampled(surface, fine), 0, Edge::mirror};
  scene.beam.energy_ev = scope.energy_ev;
  scene.beam.spot_nm = scope.spot_nm;
  for (const mc::Detector& d : taught_by(model.trained))
    if (has_channel(model, d.name)) scene.detectors.push_back(d);
  const int width = sem.values.width(), height = sem.values.height();
  scene.scan.width = width;
  scene.scan.height = height;
  scene.scan.region = mc::ScanRequest::Region{sem.x_nm(-0.5), sem.y_nm(-0.5), sem.x_nm(width - 0.5),
                                              sem.y_nm(height - 0.5)};
  scene.physics = request.physics;
  scene.budget = mc::ElectronsPerPixel{request.electrons};
  scene.seed = request.seed;
  job.execution.threads = request.threads;
  job.estimate = {Estimate::guided, model.file.string()};
  job.cache = request.cache;
  job.checkpoint.wanted = false;
  return job;
}

double mean_of(const Grid<double>& image) {
  double sum = 0;
  for (const double v : image.data()) sum += v;
  return sum / static_cast<double>(image.size());
}

/// A correction counts as far as it is more than its own error around: what is left of it, and of
/// its error, is what is expected of fields of that size (Wiener).
void shrink(Grid<double>& off, Grid<double>& error) {
  constexpr double around_px = 6;
  Grid<double> seen = off, noise = error;
  const Grid<double> ones(off.width(), off.height(), 1.0);
  for (double& v : seen.data()) v *= v;
  for (double& v : noise.data()) v *= v;
  seen = mean_around(seen, ones, around_px);
  noise = mean_around(noise, ones, around_px);
  for (std::size_t i = 0; i < off.size(); ++i) {
    const double share =
        seen.data()[i] > 0 ? std::max(0.0, 1 - noise.data()[i] / seen.data()[i]) : 0;
    off.data()[i] *= share;
    error.data()[i] *= std::sqrt(share);
  }
}

}  // namespace

bool can_be_corrected(const StoredModel& model, const mc::Material& material) {
  std::vector<mc::Detector> known = mc::default_detectors();
  for (mc::Detector& d : taught_by(model.trained)) known.push_back(std::move(d));
  return !material.name.empty() && model.trained.scope.energy_ev > 0 &&
         std::ranges::all_of(model.model->channels(), [&](const std::string& name) {
           return std::ranges::find(known, name, &mc::Detector::name) != known.end();
         });
}

ModelCorrection correction_at(const HeightField& surface, const PlacedImage& sem,
                              const StoredModel& model, const CorrectionRequest& request,
                              const Reporter& reporter) {
  const SimulateSummary done = run(simulation_of(surface, sem, model, request), reporter);
  if (!done.result.complete) throw Interrupted();
  ModelOptions options;
  options.threads = request.threads;
  const ModelImages predicted = model.model->predict(surface, options);
  const auto left =
      static_cast<int>(std::lround((sem.origin_x_nm - surface.origin_x_nm) / surface.pitch_x_nm));
  const auto below =
      static_cast<int>(std::lround((sem.origin_y_nm - surface.origin_y_nm) / surface.pitch_y_nm));
  ModelCorrection out;
  out.primaries = done.result.balance.incident;
  out.seconds = done.result.seconds;
  for (std::size_t c = 0; c < predicted.size(); ++c) {
    const auto detector =
        std::ranges::find(done.result.detectors, model.model->channels()[c], &mc::Detector::name);
    const GuidedImage& image =
        done.guided[static_cast<std::size_t>(detector - done.result.detectors.begin())];
    out.off.emplace_back(sem.values.width(), sem.values.height());
    out.error.emplace_back(image.error);
    out.mean.push_back(mean_of(image.mean));
    for (int y = 0; y < sem.values.height(); ++y)
      for (int x = 0; x < sem.values.width(); ++x)
        out.off[c](x, y) = image.mean(x, y) - predicted[c](x + left, y + below);
    shrink(out.off[c], out.error[c]);
  }
  return out;
}

}  // namespace surf::workflow
