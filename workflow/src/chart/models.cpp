// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "../training_data.h"
#include "chart_files.h"
#include "chart_methods.h"
#include "surf/core/error.h"
#include "surf/io/model/model_file.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/geometry/surface_view.h"
#include "surf/mc/physics/electron_range.h"
#include "surf/sem/filter_bank.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int repeats = 3;  // predictions shorter than `short_s` are repeated
constexpr double short_s = 0.5;
// Models see beyond the image's edge: this many ranges, but at most `most_margin_px` pixels.
constexpr double margin_ranges = 2;
constexpr int most_margin_px = 48;
constexpr int quick_surfaces = 3, quick_surface_px = 32, quick_iterations = 100;
constexpr std::int64_t quick_electrons = 40, quick_table = 2048;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Says why fast models do not apply to the scene, if so.
std::optional<std::string> obstacle(const ChartSetting& setting) {
  const io::SceneFile& s = setting.job.scene;
  if (s.beam.tilt_deg != 0 || s.beam.convergence_deg != 0 || s.beam.working_distance_nm != 0)
    return "they are for a parallel beam from straight above";
  if (std::abs(setting.scan.pixel_x_nm - setting.scan.pixel_y_nm) > 1e-9 * setting.scan.pixel_x_nm)
    return "they are for square pixels";
  if (setting.scan.width < 2 || setting.scan.height < 2)
    return "they need an image of two pixels or more each way";
  const mc::Scene scene(s.specimen, s.beam, setting.scan, s.physics);
  if (scene.materials().size() != 1) return "they are for one material";
  const Image view = mc::surface_view(scene, setting.job.threads);
  const auto& valid = view.find("valid")->values.data();
  if (std::any_of(valid.begin(), valid.end(), [](float v) { return v < 0.5f; }))
    return "the beam meets nothing in some pixels";
  return std::nullopt;
}

const mc::Material& material_of(const io::SceneFile& scene) {
  const mc::Specimen& s = scene.specimen;
  const int used = s.height_field     ? s.height_field->material
                   : s.bodies.empty() ? s.substrate->material
                                      : s.bodies[0].material;
  return s.materials[static_cast<std::size_t>(used)];
}

struct Heights {
  HeightField field;
  int margin = 0;  // pixels on each side outside the image
};

// The heights that the beam sees from above, including a margin beyond the image's edge.
Heights heights_of(const ChartSetting& setting) {
  const io::SceneFile& s = setting.job.scene;
  const double range_px = margin_ranges *
                          mc::kanaya_okayama_range_nm(material_of(s), s.beam.energy_ev) /
                          setting.scan.pixel_x_nm;
  for (const int margin :
       {static_cast<int>(std::min<double>(most_margin_px, std::ceil(range_px))), 0}) {
    mc::Scan scan = setting.scan;
    scan.width += 2 * margin;
    scan.height += 2 * margin;
    const Image view =
        mc::surface_view(mc::Scene(s.specimen, s.beam, scan, s.physics), setting.job.threads);
    const auto& valid = view.find("valid")->values.data();
    // The specimen may end at the image's edge.
    if (margin > 0 && std::any_of(valid.begin(), valid.end(), [](float v) { return v < 0.5f; }))
      continue;
    Heights out;
    out.margin = margin;
    out.field.z_nm = Grid<double>(scan.width, scan.height);
    const Grid<float>& z = view.find("z_nm")->values;
    for (std::size_t i = 0; i < z.size(); ++i) out.field.z_nm.data()[i] = z.data()[i];
    out.field.pitch_x_nm = out.field.pitch_y_nm = setting.scan.pixel_x_nm;
    return out;
  }
  throw InvalidInput("scene", "the beam meets nothing in some pixels", "Leave out the fast models");
}

TrainJob training(const ChartSetting& setting, const LearnOptions& learn, const std::string& name) {
  const ChartJob& job = setting.job;
  TrainJob out;
  out.surfaces = job.quick ? std::min(job.surfaces, quick_surfaces) : job.surfaces;
  out.surface_px = job.quick ? std::min(job.surface_px, quick_surface_px) : job.surface_px;
  out.pixel_nm = setting.scan.pixel_x_nm;
  out.material = material_of(job.scene);
  out.energy_ev = job.scene.beam.energy_ev;
  out.spot_nm = job.scene.beam.spot_nm;
  out.physics = job.scene.physics;
  out.simulation.budget = mc::ElectronsPerPixel{
      job.quick ? std::min(job.training_electrons, quick_electrons) : job.training_electrons};
  out.simulation.threads = job.threads;
  out.simulation.seed = job.seed;
  out.learn = learn;
  if (job.quick && learn.kind == "facet-network") out.learn.iterations = quick_iterations;
  out.output = job.folder / "models" / (name + ".json");
  out.images = job.folder / "models" / "images";
  return out;
}

// The simplest training that needs the images, which all kinds share.
TrainJob training_of_images(const ChartSetting& setting) {
  LearnOptions least;
  least.kind = "secant";
  return training(setting, least, "secant");
}

fs::path times_of_images(const TrainJob& job) { return job.images / "seconds.json"; }

void predict(const LearnOptions& learn, const std::string& id, bool needs_images,
             const ChartSetting& setting, const Watch& watch, ChartPoint& point) {
  double preparation_s = 0;
  if (needs_images) {
    make_images(setting, watch.part(0, 0.5), nullptr);
    preparation_s = read_seconds(times_of_images(training_of_images(setting)));
  }
  TrainJob job = training(setting, learn, id);
  if (!needs_images) job.surfaces.reset();  // no surfaces if no images are needed
  Reporter reporter;
  const Watch learning = watch.part(0.5, 0.9);
  reporter.on_progress = [&](double done, double total, std::string_view things) {
    if (learning.progress && things.empty()) learning.progress(done, total);
  };
  reporter.cancel = watch.cancel;
  const auto start = Clock::now();
  const TrainSummary trained = run(job, reporter);
  if (!trained.complete) throw Interrupted();
  preparation_s += seconds_since(start);
  const Heights heights = heights_of(setting);
  const auto model = make_model(trained.model);
  ModelOptions options;
  options.edge = Edge::mirror;
  options.threads = setting.job.threads;
  ModelImages images;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const auto begin = Clock::now();
    images = model->predict(heights.field, options);
    times.push_back(seconds_since(begin));
    if (times.back() > short_s) break;
  }
  std::sort(times.begin(), times.end());
  point.run_s = times[times.size() / 2];
  point.preparation_s = preparation_s;
  const auto& names = model->channels();
  const auto value = [&](std::size_t c, int x, int y) {
    const auto at = std::find(names.begin(), names.end(), setting.reference->channels[c].name);
    const auto& image = images[static_cast<std::size_t>(at - names.begin())];
    return image(x + heights.margin, y + heights.margin);
  };
  judge(*setting.reference,
        take_compared(*setting.reference, value, static_cast<const decltype(value)*>(nullptr)),
        setting.accuracies, point);
}

std::vector<FacetScale> first_scales(int count, bool uniform) {
  std::vector<FacetScale> scales = thesis_scales();
  scales.resize(static_cast<std::size_t>(count));
  if (uniform)
    for (FacetScale& scale : scales) scale.sigma_px = 0;
  return scales;
}

}  // namespace

ManyDone make_images(const ChartSetting& setting, const Watch& watch, Team* team) {
  const TrainJob job = training_of_images(setting);
  std::vector<TrainingSurface> surfaces;
  together(team, [&] { surfaces = gather_surfaces(job, *job.surfaces, {}); });
  Reporter reporter;
  reporter.on_progress = [&](double done, double total, std::string_view things) {
    if (watch.progress && things == "pixels") watch.progress(done, total);
  };
  reporter.cancel = watch.cancel;
  const SimulatedImages done = simulate_images(job, surfaces, reporter, team, true);
  together(team, [&] {
    const fs::path times = times_of_images(job);
    if (leads(team) && done.made > 0)
      write_seconds(times, (done.found > 0 ? read_seconds(times) : 0) + done.runs.seconds);
  });
  if (!done.runs.complete) throw Interrupted();
  return done.runs;
}

ChartMethods list_models(const ChartSetting& setting) {
  const ChartJob& job = setting.job;
  ChartMethods out;
  const auto families = chart_families();
  if (std::none_of(families.begin(), families.end(),
                   [&](const ChartFamily& f) { return !f.simulates && wants(job, f.name); }))
    return out;
  if (const auto reason = obstacle(setting)) {
    out.left_out.push_back("fast models: " + *reason);
    return out;
  }
  const auto add = [&](const std::string& family, const std::string& id,
                       const std::string& setting_text, const LearnOptions& learn,
                       bool needs_images = true) {
    if (!wants(job, family)) return;
    ChartMethod method{id, family, setting_text, false, {}};
    method.run = [learn, id, needs_images](const ChartSetting& s, const Watch& watch,
                                           ChartPoint& point) {
      predict(learn, id, needs_images, s, watch, point);
    };
    method.needs_images = needs_images;
    out.methods.push_back(std::move(method));
  };
  const auto kind = [](const char* name) {
    LearnOptions learn;
    learn.kind = name;
    return learn;
  };
  add("facet-network", "facet-network", "as train makes it", kind("facet-network"));
  for (const int scales :
       job.quick ? std::vector<int>{2, 10} : std::vector<int>{1, 2, 3, 5, 7, 10}) {
    LearnOptions bank = kind("filter-bank");
    bank.scales = first_scales(scales, false);
    add("filter-bank", fmt::format("filter-bank-{}", scales),
        fmt::format("{} scale{}, Gaussian weights", scales, scales == 1 ? "" : "s"), bank);
  }
  for (const int scales : job.quick ? std::vector<int>{10} : std::vector<int>{3, 10}) {
    LearnOptions bank = kind("filter-bank");
    bank.scales = first_scales(scales, true);
    add("filter-bank", fmt::format("filter-bank-{}-uniform", scales),
        fmt::format("{} scales, uniform weights", scales), bank);
  }
  LearnOptions coarse = kind("filter-bank");
  coarse.scales = first_scales(10, false);
  coarse.multi_resolution = true;
  add("filter-bank", "filter-bank-10-multi", "10 scales, wide ones on fewer samples", coarse);
  for (const LearnableKind& k : learnable_kinds())
    if (k.name != "facet-network" && k.name != "filter-bank") {
      LearnOptions learn = kind(k.name.c_str());
      if (job.quick && !k.needs_images) learn.table_electrons = quick_table;
      add(k.name, k.name,
          k.needs_images ? "gain learnt from images" : "from Monte Carlo of its own", learn,
          k.needs_images);
    }
  return out;
}

}  // namespace surf::workflow
