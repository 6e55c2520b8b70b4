// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/chart_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>

#include "../finished_image.h"
#include "../job_identity.h"
#include "chart_files.h"
#include "chart_methods.h"
#include "chart_plot.h"
#include "compared_pixels.h"
#include "peak_memory.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/plot.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/sampling/choose_method.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

// Offset of the reference's seed, so that it shares no library with a point.
constexpr std::uint64_t other_seed = 1'000'003;

ChartJob complete(const ChartJob& asked) {
  check_parameters(asked);
  ChartJob job = asked;
  if (job.quick) {
    job.finest = std::max(job.finest, 0.03);
    job.most_primaries = std::min(job.most_primaries, 5e6);
    job.compared_pixels = std::min(job.compared_pixels, 400);
  }
  if (job.reference_accuracy == 0) job.reference_accuracy = job.finest / 3;
  if (job.reference_accuracy > 0.5 * job.finest)
    throw UsageError("`chart.reference`",
                     fmt::format("{} is not well below the finest accuracy, {}",
                                 format_share(job.reference_accuracy), format_share(job.finest)),
                     "Give at most half of it, and 0.01% at least");
  for (const std::string& family : job.families) {
    const auto& all = chart_families();
    if (std::none_of(all.begin(), all.end(),
                     [&](const ChartFamily& f) { return f.name == family; })) {
      std::string names;
      for (const ChartFamily& f : all) names += (names.empty() ? "" : ", ") + f.name;
      throw UsageError("`chart.methods`", fmt::format("'{}' is none of them", family),
                       "Choose of " + names);
    }
  }
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=chart`");
  if (mc::dose_of(job.scene.budget) > 0)
    throw UsageError("scene",
                     "with a current and a dwell time pixels get random numbers of electrons",
                     "Leave both out: the chart compares numbers of electrons");
  return job;
}

std::vector<double> accuracies_of(const ChartJob& job) {
  std::vector<double> out;
  for (const double a : job.quick ? std::vector<double>{0.1, 0.03}
                                  : std::vector<double>{0.1, 0.05, 0.03, 0.02, 0.01})
    if (a > job.finest * (1 + 1e-9)) out.push_back(a);
  out.push_back(job.finest);
  return out;
}

// Below this accuracy libraries of cascades would take too much memory. The reference is then the
// mean of several images with separate libraries.
constexpr double finest_at_once = 0.007;

double floor_of_scene(const ChartJob& job) {
  return mc::accuracy_of(job.scene.budget) > 0 ? mc::floor_of(job.scene.budget)
                                               : mc::Accuracy{}.floor;
}

std::vector<SimulateJob> reference_jobs(const ChartJob& job, const ComparedPixels& pixels,
                                        const mc::Scan& scan) {
  const int parts = std::max(
      1, static_cast<int>(std::ceil(std::pow(finest_at_once / job.reference_accuracy, 2) - 1e-9)));
  std::vector<SimulateJob> out;
  for (int i = 0; i < parts; ++i) {
    SimulateJob part;
    part.scene = job.scene;
    part.scene.scan = request_for(pixels, scan);
    part.scene.method.reset();
    part.scene.mesh_tolerance_nm = 0;
    part.scene.detectors.clear();
    const double accuracy = job.reference_accuracy * std::sqrt(parts);
    part.scene.budget = mc::Accuracy{accuracy, floor_of_scene(job) * accuracy / job.finest};
    part.scene.seed = job.seed + other_seed + static_cast<std::uint64_t>(i);
    part.execution.threads = job.threads;
    part.outputs = {job.folder / "reference" / fmt::format("{}.exr", i + 1)};
    part.command_line = job.command_line;
    title_by_identity(part, "reference of a chart");
    out.push_back(std::move(part));
  }
  return out;
}

Image mean_of(const std::vector<SimulateJob>& parts) {
  Image mean = io::read_image(parts.front().outputs.front());
  const auto n = static_cast<float>(parts.size());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const Image other = io::read_image(parts[i].outputs.front());
    for (Channel& channel : mean.channels) {
      const bool error = channel.name.ends_with(".stderr");
      const Grid<float>& more = other.find(channel.name)->values;
      for (std::size_t k = 0; k < more.size(); ++k) {
        float& value = channel.values.data()[k];
        value = error ? std::hypot(value, more.data()[k]) : value + more.data()[k];
      }
    }
  }
  for (Channel& channel : mean.channels)
    for (float& value : channel.values.data()) value /= n;
  return mean;
}

// Identifies everything that errors depend on, so that points of another job do not count.
std::string identity(const ChartJob& job, const std::vector<SimulateJob>& reference,
                     const std::vector<double>& accuracies) {
  Identity id{
      {"reference", reference.front().scene.title},
      {"parts", std::to_string(reference.size())},
      {"seed", std::to_string(job.seed)},
      {"quick", job.quick ? "yes" : "no"},
      {"training", fmt::format("{} {} {}", job.surfaces, job.surface_px, job.training_electrons)}};
  id.merge(surf::record_of(mc::words_of(job.scene.budget)));
  id["tolerance"] = format_exact(job.scene.mesh_tolerance_nm);
  if (job.scene.method) id["method"] = mc::name(*job.scene.method);
  for (const double a : accuracies) id["accuracies"] += format_exact(a) + " ";
  return fingerprint(id).substr(0, 32);
}

std::vector<ChartChoice> choices_of(const ChartSetting& setting,
                                    const std::vector<ChartPoint>& points) {
  std::vector<ChartChoice> out;
  const ChartJob& job = setting.job;
  const mc::Scene scene(job.scene.specimen, job.scene.beam, setting.scan, job.scene.physics);
  for (std::size_t i = 0; i < setting.accuracies.size(); ++i) {
    mc::SimulationOptions options;
    options.budget = mc::Accuracy{setting.accuracies[i], floor_of_scene(job)};
    options.seed = job.seed;
    const mc::MethodChoice choice = mc::choose_method(scene, options);
    ChartChoice c;
    c.accuracy = setting.accuracies[i];
    c.reason = fmt::format("{}: {}", mc::name(choice.method), choice.reason);
    const std::string id =
        id_of_accuracy(choice.method, options.planar_control, setting.accuracies[i]);
    const ChartPoint *chosen = nullptr, *fastest = nullptr;
    for (const ChartPoint& p : points) {
      if (p.id == id) chosen = &p;
      if (p.targets[i].met && (!fastest || p.total_s() < fastest->total_s())) fastest = &p;
    }
    if (chosen) {
      c.id = id;
      c.met = chosen->targets[i].met;
    }
    if (fastest) c.fastest = fastest->id;
    if (chosen && fastest) c.ratio = chosen->total_s() / fastest->total_s();
    out.push_back(std::move(c));
  }
  return out;
}

fs::path point_file(const ChartJob& job, const ChartMethod& method) {
  return job.folder / "points" / (method.id + ".json");
}

// Makes the training images of a team before any point is timed. Without a team the first point
// that needs them makes them.
ManyDone make_images_for(const ChartSetting& setting, const std::vector<ChartMethod>& methods,
                         const std::string& id, const Watch& watch, Team& team) {
  std::string wanted = "no";
  for (const ChartMethod& method : methods)  // the leader has the stored points
    if (method.needs_images && !read_point(point_file(setting.job, method), id)) wanted = "yes";
  team.broadcast(wanted);
  return wanted == "yes" ? make_images(setting, watch, &team) : ManyDone{};
}

// The progress over all points. The reference counts as much as all points together, because it
// takes the most electrons.
class Course {
 public:
  Course(const Reporter& reporter, double points) : reporter_(reporter), points_(points) {}

  ProgressCallback show(double weight) {
    return [this, weight](double done, double total) {
      if (total > 0) reporter_.progress(before_ + weight * done / total, 2 * points_);
    };
  }
  ProgressCallback show_reference() { return show(points_); }
  void end_reference() { before_ = points_; }
  void end_point() {
    before_ += 1;
    reporter_.progress(before_, 2 * points_);
  }

 private:
  const Reporter& reporter_;
  double points_, before_ = 0;
};

ManyDone make_reference(const ChartJob& job, const std::vector<SimulateJob>& parts,
                        const mc::Scan& scan, const Reporter& reporter, Course& course,
                        Team* team) {
  std::string letters;  // the leader decides for all
  for (const SimulateJob& part : parts) letters += leads(team) && is_finished(part) ? '+' : '-';
  if (team) team->broadcast(letters);
  std::vector<const SimulateJob*> missing;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (letters[i] == '-') missing.push_back(&parts[i]);
  ManyRuns runs;
  runs.weights.assign(missing.size(), 1);
  runs.make = [&](std::size_t i) { return *missing[i]; };
  runs.folder = job.folder / "reference";
  runs.tiles = tiles_of(scan);
  runs.pixels = static_cast<double>(scan.width) * scan.height;
  runs.threads = job.threads;
  const ProgressCallback show = course.show_reference();
  runs.reporter = reporter;
  runs.reporter.on_progress = [&](double done, double total, std::string_view things) {
    if (things != "cascades") show(done, total);
  };
  const ManyDone done = run_many(runs, team);
  course.end_reference();
  if (!team || !done.complete) return done;
  together(team, [&] {
    if (!team->leads()) return;
    for (const SimulateJob* part : missing)
      await_file(part->outputs.front(), [&] { return is_finished(*part); });
  });
  return done;
}

// Runs the missing points.
void make_points(const ChartSetting& setting, const std::vector<ChartMethod>& methods,
                 const std::string& id, const Reporter& reporter, const PointCallback& on_point,
                 Course& course, ChartSummary& summary) {
  for (const ChartMethod& method : methods) {
    const fs::path file = point_file(setting.job, method);
    std::optional<ChartPoint> point = read_point(file, id);
    if (point) {
      ++summary.found;
    } else {
      if (reporter.cancelled()) {
        summary.complete = false;
        return;
      }
      point = ChartPoint{method.id, method.family, method.setting};
      point->is_default = method.is_default;
      try {
        const PeakMemory memory;
        method.run(setting, {course.show(1), reporter.cancel}, *point);
        point->peak_bytes = memory.bytes();
      } catch (const Interrupted&) {
        summary.complete = false;
        return;
      }
      write_point(file, *point, id);
      if (on_point) on_point(*point);
    }
    summary.points.push_back(std::move(*point));
    course.end_point();
  }
}

void write_chart(const ChartJob& job, ChartSummary& summary) {
  io::write_text(job.folder / "chart.csv", csv_text(summary));
  io::write_text(job.folder / "chart.json", json_text(job, summary));
  summary.written = {job.folder / "chart.csv", job.folder / "chart.json"};
  io::Plot plot = chart_plot(job, summary);
  plot.metadata =
      step_record("chart", records_of(job, static_cast<const mc::SimulationRequest&>(job.scene)));
  for (const char* name : {"chart.svg", "chart.png"}) {
    io::write_plot(job.folder / name, plot);
    summary.written.push_back(job.folder / name);
  }
}

}  // namespace

const std::vector<ChartFamily>& chart_families() {
  static const std::vector<ChartFamily> families = [] {
    std::vector<ChartFamily> all{
        {"default", "what 'semsurf simulate' does with the scene, nothing else being said", true},
        {"direct", "each electron followed, the same number for each pixel", true},
        {"replay", "stored cascades retraced, the same number for each pixel", true},
        {"guided", "few electrons, estimated with neighbours, guided by shape", true},
        {"accuracy", "replay, as many electrons as each pixel needs, with planes as controls",
         true},
        {"accuracy-without-planes", "the same without planes", true},
        {"direct-accuracy", "the same with electrons that are followed", true},
        {"mesh-tolerance", "a height field simplified, at one accuracy", true}};
    for (const LearnableKind& kind : learnable_kinds())
      all.push_back({kind.name, kind.what, false});
    return all;
  }();
  return families;
}

bool wants(const ChartJob& job, const std::string& family) {
  return job.families.empty() ||
         std::find(job.families.begin(), job.families.end(), family) != job.families.end();
}

double ChartPoint::worst_rms() const {
  double worst = 0;
  for (const ChartChannel& c : channels) worst = std::max(worst, c.error.rms);
  return worst;
}

ChartSummary run(const ChartJob& asked, const Reporter& reporter, const PointCallback& on_point,
                 Team* team) {
  const auto start = std::chrono::steady_clock::now();
  ChartJob job;
  together(team, [&] { job = complete(asked); });
  ChartSummary summary;
  ChartSetting setting{job, {}, nullptr, accuracies_of(job)};
  ComparedPixels pixels;
  std::vector<SimulateJob> parts;
  std::string id;
  std::vector<ChartMethod> methods;  // on the leader
  together(team, [&] {
    setting.scan = resolve_scan(job.scene.scan, mc::extent(job.scene.specimen), job.scene.beam);
    pixels = choose_pixels(setting.scan, job.compared_pixels);
    summary.compared = pixels.width * pixels.height;
    parts = reference_jobs(job, pixels, setting.scan);
    id = identity(job, parts, setting.accuracies);
    if (!leads(team)) return;
    for (const char* name : {"chart.csv", "chart.json"}) io::check_writable(job.folder / name);
    for (const char* name : {"chart.svg", "chart.png"}) io::check_plot_target(job.folder / name);
    for (ChartMethods& list : std::array{list_simulations(setting), list_models(setting)}) {
      std::ranges::move(list.methods, std::back_inserter(methods));
      std::ranges::move(list.left_out, std::back_inserter(summary.left_out));
    }
    if (methods.empty())
      throw UsageError("`chart.methods`", "none of them can be had with this scene",
                       "Leave it out for all that can");
  });

  Course course(reporter, static_cast<double>(methods.size()));
  mc::Scan compared;
  compared.width = pixels.width;
  compared.height = pixels.height;
  ManyDone done = make_reference(job, parts, compared, reporter, course, team);
  try {
    if (team && done.complete)
      done.add(make_images_for(setting, methods, id, {course.show(1), reporter.cancel}, *team));
  } catch (const Interrupted&) {
    done.complete = false;
  }
  summary.complete = done.complete;
  if (!summary.complete) return summary;

  together(team, [&] {
    if (!leads(team)) return;
    const Reference reference = read_reference(mean_of(parts), pixels, floor_of_scene(job));
    setting.reference = &reference;
    for (const ComparedChannel& c : reference.channels)
      summary.reference.push_back({c.name, image_error(c.values, {}, c.values, c.standard_errors)});
    make_points(setting, methods, id, reporter, on_point, course, summary);
    if (!summary.complete) return;
    summary.choices = choices_of(setting, summary.points);
    write_chart(job, summary);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (team)
      io::write_text(job.folder / "chart.run.json",
                     team_record(*team, done, seconds.count(), job.threads, job.command_line));
  });
  return summary;
}

}  // namespace surf::workflow
