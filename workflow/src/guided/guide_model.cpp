// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided/guide_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/stored_model.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr double same_pixel = 1e-3;  // relative, as models demand
// Of the pixels that training surfaces are designed for, nm.
constexpr double finest_trained = 0.5, coarsest_trained = 10;
constexpr double most_pixel_ratio = 4;  // beyond, a model says little about the pixels

// How many times the electrons images take without a model: 1.3 times on rough ground, 1.05 to 1.1
// times on plateaus and trenches (docs/development/guided_images.md).
constexpr double usual_worth = 1.15;

GuideModel none(std::string reason) { return {nullptr, "none", std::move(reason)}; }

GuideModel loaded(const fs::path& file, TrainedModel trained, const std::string& reason) {
  return {make_model(trained),
          fmt::format("{} sha256 {}", file.filename().string(), io::sha256_of_file(file)), reason};
}

bool has_fast_models(const mc::Scene& scene) {
  return scene.materials().size() == 1 && scene.beam().tilt_deg == 0 &&
         scene.beam().working_distance_nm <= 0;
}

ModelRequest request_for(const mc::Scene& scene) {
  ModelRequest request;
  request.material = scene.materials().front();
  request.energy_ev = scene.beam().energy_ev;
  request.spot_nm = scene.beam().spot_nm;
  request.physics = scene.physics();
  request.pixel_nm = std::sqrt(scene.scan().pixel_x_nm * scene.scan().pixel_y_nm);
  return request;
}

/// The model of the cache whose pixel is nearest to the scan's, among those that would be trained
/// for this material, energy, spot and physics.
std::optional<GuideModel> find_stored(const mc::Scene& scene, const fs::path& folder) {
  ModelRequest request = request_for(scene);
  const double pixel_nm = request.pixel_nm;
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::ranges::sort(files);
  // Names begin with material and energy.
  const std::string usual = kept_name(request), beginning = usual.substr(0, usual.find("ev-") + 3);
  std::optional<GuideModel> best;
  double nearest = std::log(most_pixel_ratio);
  for (const fs::path& file : files) {
    if (!file.filename().string().starts_with(beginning)) continue;
    try {
      TrainedModel trained = io::read_model(file);
      request.pixel_nm = trained.scope.pixel_nm;
      if (!(request.pixel_nm > 0) || kept_name(request) != file.filename()) continue;
      const double away = std::abs(std::log(request.pixel_nm / pixel_nm));
      if (away >= nearest) continue;
      nearest = away;
      best = loaded(file, std::move(trained),
                    fmt::format("by the kept model {}", file.filename().string()));
    } catch (const Error&) {  // a damaged file guides nobody; whoever asks for it is told
    }
  }
  return best;
}

/// Cubic convolution (Keys 1981, doi:10.1109/TASSP.1981.1163711): without kinks at samples, which
/// would look like detail.
std::array<double, 4> cubic_weights(double t) {
  return {((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1,
          ((-1.5 * t + 2) * t + 0.5) * t, (0.5 * t - 0.5) * t * t};
}

double interpolated(const Grid<double>& image, double x, double y) {
  x = std::clamp(x, 0.0, image.width() - 1.0);
  y = std::clamp(y, 0.0, image.height() - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const auto wx = cubic_weights(x - x0), wy = cubic_weights(y - y0);
  double sum = 0;
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 4; ++u)
      sum += wx[static_cast<std::size_t>(u)] * wy[static_cast<std::size_t>(v)] *
             image(std::clamp(x0 + u - 1, 0, image.width() - 1),
                   std::clamp(y0 + v - 1, 0, image.height() - 1));
  return sum;
}

bool training_pays(const mc::Scene& scene, double primaries) {
  const ModelRequest request = request_for(scene);
  return request.pixel_nm >= finest_trained && request.pixel_nm <= coarsest_trained &&
         primaries * (1 - 1 / usual_worth) > training_primaries(request);
}

}  // namespace

bool trains_guide_model(const EstimateOptions& options, const mc::Scene& scene,
                        const fs::path& cache, double primaries) {
  return options.model == "auto" && has_fast_models(scene) && !cache.empty() &&
         training_pays(scene, primaries) && !find_stored(scene, cache / "models");
}

GuideModel find_guide_model(const EstimateOptions& options, const mc::Scene& scene,
                            const fs::path& cache, double primaries, int threads,
                            const Reporter& reporter) {
  if (options.model == "off") return none("without a fast model, as asked");
  if (options.model != "auto") {
    const fs::path file = options.model;
    return loaded(file, io::read_model(file),
                  fmt::format("by the model {}", file.filename().string()));
  }
  if (scene.materials().size() > 1) return none("by shape alone: fast models are of one material");
  if (scene.beam().tilt_deg != 0 || scene.beam().working_distance_nm > 0)
    return none("by shape alone, because fast models need a vertical beam");
  if (cache.empty()) return none("by shape alone: there is no cache with fast models");
  if (auto stored = find_stored(scene, cache / "models")) return *std::move(stored);
  if (training_pays(scene, primaries)) {
    ModelRequest request = request_for(scene);
    request.folder = cache / "models";
    request.threads = threads;
    StoredModel made = find_model(request, reporter);
    return loaded(made.file, std::move(made.trained),
                  fmt::format("by a model trained for it, {}", made.file.filename().string()));
  }
  return none(fmt::format(
      "by shape alone: the cache has no fast model of {} at {:g} eV with pixels near {}",
      scene.materials().front().name, scene.beam().energy_ev,
      format_length(std::sqrt(scene.scan().pixel_x_nm * scene.scan().pixel_y_nm))));
}

std::vector<Guide> predicted_guides(const GuideModel& guide, const SeenSurface& surface,
                                    int threads, const Watch& watch) {
  if (!guide.model) return {};
  const int width = surface.seen.width(), height = surface.seen.height();
  double lowest = 0;
  bool any = false;
  for (std::size_t i = 0; i < surface.seen.size(); ++i)
    if (surface.seen.data()[i]) {
      lowest = any ? std::min(lowest, surface.height_nm.data()[i]) : surface.height_nm.data()[i];
      any = true;
    }
  if (!any || width < 3 || height < 3) return {};
  HeightField field;
  field.pitch_x_nm = surface.pixel_x_nm;
  field.pitch_y_nm = surface.pixel_y_nm;
  field.z_nm = surface.height_nm;
  for (std::size_t i = 0; i < surface.seen.size(); ++i)
    if (!surface.seen.data()[i]) field.z_nm.data()[i] = lowest;
  const double model_nm = guide.model->scope().pixel_nm;
  const auto other = [&](double pixel_nm) {
    return model_nm > 0 && std::abs(pixel_nm - model_nm) > same_pixel * model_nm;
  };
  const bool resample = other(field.pitch_x_nm) || other(field.pitch_y_nm);
  if (resample && (model_nm > (width - 1) * field.pitch_x_nm / 3 ||
                   model_nm > (height - 1) * field.pitch_y_nm / 3))
    return {};  // the scan is hardly a pixel of the model
  const HeightField seen = resample ? resampled(field, model_nm) : field;
  const ModelImages images = guide.model->predict(seen, {.threads = threads, .watch = watch});
  std::vector<Guide> guides;
  for (std::size_t c = 0; c < images.size(); ++c) {
    Guide predicted{guide.model->channels()[c], Grid<double>(width, height, 0.0), true};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        predicted.values(x, y) = interpolated(images[c], x * field.pitch_x_nm / seen.pitch_x_nm,
                                              y * field.pitch_y_nm / seen.pitch_y_nm);
    guides.push_back(std::move(predicted));
  }
  return guides;
}

}  // namespace surf::workflow
