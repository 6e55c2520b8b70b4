// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "chart_methods.h"
#include "guided/guided_images.h"
#include "guided/guided_simulation.h"
#include "guided/scene_guides.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/sampling/choose_method.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/simplify_specimen.h"

namespace surf::workflow {
namespace {

using Clock = std::chrono::steady_clock;

// Direct simulation is about 20 times slower, so with a twentieth of the primaries all points take
// about as long.
constexpr double direct_share = 1.0 / 20;
// Shorter simulations are repeated, because a single measurement is inaccurate.
constexpr double short_s = 0.5;
constexpr int repeats = 3;
constexpr double cascades_of_charts = 1e5;  // of guided images, at most

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Simulation {
  mc::SimulationOptions options;
  double tolerance_nm = 0;
  bool guided = false;  // by shape alone
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void simulate(const Simulation& what, const ChartSetting& setting, const Watch& watch,
              ChartPoint& point) {
  const io::SceneFile& scene = setting.job.scene;
  std::vector<double> run_s, preparation_s;
  for (int i = 0; i < repeats; ++i) {
    const auto start = Clock::now();
    mc::Specimen specimen = scene.specimen;
    Simplification done;
    if (what.tolerance_nm > 0)
      specimen = simplify_specimen(scene.specimen, what.tolerance_nm, scene.beam, setting.scan,
                                   scene.physics, setting.job.threads, done);
    const mc::Scene ready(specimen, scene.beam, setting.scan, scene.physics);
    const double building_s = seconds_since(start);
    const mc::SimulationResult r = mc::simulate(ready, what.options, {.watch = watch});
    if (!r.complete) throw Interrupted();
    std::vector<GuidedImage> guided;
    const auto estimating = Clock::now();
    if (what.guided)
      guided =
          estimate_images(r,
                          guides_of(ready, find_guide_model({Estimate::guided, "off"}, ready, {}),
                                    what.options.threads, watch),
                          what.options.threads, watch);
    run_s.push_back(r.seconds + (what.guided ? seconds_since(estimating) : 0));
    preparation_s.push_back(building_s + r.library_seconds);
    if (i == 0) {
      point.primaries = r.balance.incident;
      const auto is_guided = [&](std::size_t d, int x, int y) {
        return d < guided.size() && guided[d].radius_px(x, y) > 0;
      };
      const auto value = [&](std::size_t d, int x, int y) {
        return is_guided(d, x, y) ? guided[d].mean(x, y) * r.detectors[d].efficiency
                                  : r.yield(d, x, y).mean;
      };
      const auto error = [&](std::size_t d, int x, int y) {
        return is_guided(d, x, y) ? guided[d].error(x, y) * r.detectors[d].efficiency
                                  : r.yield(d, x, y).standard_error;
      };
      judge(*setting.reference, take_compared(*setting.reference, value, &error),
            setting.accuracies, point);
    }
    if (seconds_since(start) > short_s) break;
  }
  point.run_s = median(run_s);
  point.preparation_s = median(preparation_s);
}

class List {
 public:
  explicit List(const ChartSetting& setting)
      : setting_(setting), pixels_(static_cast<double>(setting.scan.width) * setting.scan.height) {
    options_.seed = setting.job.seed;
    options_.threads = setting.job.threads;
    if (mc::accuracy_of(setting.job.scene.budget) > 0)
      floor_ = mc::floor_of(setting.job.scene.budget);
  }

  ChartMethods out;

  void electrons(const char* family, mc::Method method, std::int64_t n) {
    const double most =
        setting_.job.most_primaries * (method == mc::Method::direct ? direct_share : 1);
    const std::string text = fmt::format("{} electrons per pixel", n);
    if (static_cast<double>(n) * pixels_ > most) return too_long(family, text);
    Simulation what{options_, 0};
    what.options.method = method;
    what.options.budget = mc::ElectronsPerPixel{n};
    add(family, fmt::format("{}-{}", family, n), text, what);
  }

  void guided(mc::Method method, std::int64_t n) {
    const double most =
        setting_.job.most_primaries * (method == mc::Method::direct ? direct_share : 1);
    const std::string text = fmt::format("{} electrons per pixel, guided by shape", n);
    if (static_cast<double>(n) * pixels_ > most) return too_long("guided", text);
    Simulation what{options_, 0, true};
    what.options.method = method;
    what.options.budget = mc::ElectronsPerPixel{n};
    what.options = guided_options(what.options, cascades_of_charts);
    add("guided", fmt::format("guided-{}", n), text, what);
  }

  void accuracy(const char* family, mc::Method method, bool control, double accuracy) {
    // For a primary that counts 0 or 1 with three zeros of four, variance / mean^2 is 3. Fewer
    // primaries suffice if planar controls help.
    const double each = (method == mc::Method::direct ? 3
                         : control                    ? 0.3
                                                      : 3) /
                        (accuracy * accuracy);
    const double most =
        setting_.job.most_primaries * (method == mc::Method::direct ? direct_share : 1);
    const std::string text = fmt::format("{} accuracy", format_share(accuracy));
    if (each * pixels_ > most) return too_long(family, text);
    Simulation what{options_, 0};
    what.options.method = method;
    what.options.budget = mc::Accuracy{accuracy, floor_};
    what.options.planar_control = control;
    add(family, id_of_accuracy(method, control, accuracy), text, what);
  }

  void tolerance(double nm, double accuracy) {
    Simulation what{options_, nm};
    what.options.method = mc::Method::replay;
    what.options.budget = mc::Accuracy{accuracy, floor_};
    add("mesh-tolerance", fmt::format("mesh-tolerance-{:g}nm", nm),
        fmt::format("detail below {} left out, {} accuracy", format_length(nm),
                    format_share(accuracy)),
        what);
  }

  // The default behaviour of `simulate` with the scene.
  void by_default() {
    const io::SceneFile& s = setting_.job.scene;
    Simulation what{options_, s.mesh_tolerance_nm};
    if (!std::holds_alternative<mc::TimeLimit>(s.budget)) what.options.budget = s.budget;
    const double accuracy = mc::accuracy_of(s.budget);
    const mc::Scene scene(s.specimen, s.beam, setting_.scan, s.physics);
    what.options.method = mc::choose_method(scene, what.options, s.method).method;
    const std::string text = accuracy > 0 ? fmt::format("{} accuracy", format_share(accuracy))
                                          : fmt::format("{:g} electrons per pixel",
                                                        mc::mean_electrons_of(what.options.budget));
    add("default", "default", fmt::format("{}, {}", text, mc::name(what.options.method)), what);
    out.methods.back().is_default = true;
  }

 private:
  void too_long(const char* family, const std::string& text) {
    out.left_out.push_back(fmt::format("{}, {}: more than {:.2g} primaries in the whole image",
                                       family, text, setting_.job.most_primaries));
  }

  void add(const char* family, std::string id, std::string text, const Simulation& what) {
    ChartMethod method{std::move(id), family, std::move(text), false, {}};
    method.run = [what](const ChartSetting& setting, const Watch& watch, ChartPoint& point) {
      simulate(what, setting, watch, point);
    };
    out.methods.push_back(std::move(method));
  }

  const ChartSetting& setting_;
  double pixels_;
  mc::SimulationOptions options_;
  double floor_ = mc::Accuracy{}.floor;
};

}  // namespace

std::string percent_text(double share) { return fmt::format("{:.6g}", 100 * share); }

std::string id_of_accuracy(mc::Method method, bool planar_control, double accuracy) {
  return fmt::format("{}-{}%",
                     method == mc::Method::direct ? "direct-accuracy"
                     : planar_control             ? "accuracy"
                                                  : "accuracy-without-planes",
                     percent_text(accuracy));
}

ChartMethods list_simulations(const ChartSetting& setting) {
  const ChartJob& job = setting.job;
  List list(setting);
  const bool replays = mc::can_replay(job.scene.physics, job.scene.specimen.materials);
  if (!replays) list.out.left_out.push_back("replay: without continuous loss there is none");
  const std::vector<std::int64_t> few =
      job.quick ? std::vector<std::int64_t>{10, 30} : std::vector<std::int64_t>{10, 30, 100, 300};
  const std::vector<std::int64_t> many =
      job.quick ? std::vector<std::int64_t>{10, 100, 1000}
                : std::vector<std::int64_t>{10, 30, 100, 300, 1000, 3000, 10000};
  if (wants(job, "default")) list.by_default();
  if (wants(job, "direct"))
    for (const std::int64_t n : few) list.electrons("direct", mc::Method::direct, n);
  if (replays && wants(job, "replay"))
    for (const std::int64_t n : many) list.electrons("replay", mc::Method::replay, n);
  if (wants(job, "guided"))
    for (const std::int64_t n : job.quick ? std::vector<std::int64_t>{16, 64}
                                          : std::vector<std::int64_t>{8, 16, 32, 64, 128, 256})
      list.guided(replays ? mc::Method::replay : mc::Method::direct, n);
  for (const double accuracy : setting.accuracies) {
    if (wants(job, "direct-accuracy"))
      list.accuracy("direct-accuracy", mc::Method::direct, false, accuracy);
    if (!replays) continue;
    if (wants(job, "accuracy")) list.accuracy("accuracy", mc::Method::replay, true, accuracy);
    if (wants(job, "accuracy-without-planes"))
      list.accuracy("accuracy-without-planes", mc::Method::replay, false, accuracy);
  }
  if (wants(job, "mesh-tolerance") && replays) {
    if (!job.scene.specimen.height_field) {
      list.out.left_out.push_back("mesh-tolerance: the specimen is no height field");
    } else {
      const double accuracy = setting.accuracies[setting.accuracies.size() / 2];
      for (const double nm :
           job.quick ? std::vector<double>{1} : std::vector<double>{0.1, 0.3, 1, 3})
        list.tolerance(nm, accuracy);
    }
  }
  return std::move(list.out);
}

}  // namespace surf::workflow
