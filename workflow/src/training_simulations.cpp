// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "finished_image.h"
#include "run_many.h"
#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/mc/physics/electron_range.h"
#include "training_data.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

SimulateJob simulation_of(const TrainJob& job, const TrainingSurface& surface, std::size_t number,
                          bool teaches, const fs::path& output) {
  SimulateJob out;
  io::SceneFile& scene = out.scene;
  scene.specimen.materials = {job.material};
  scene.specimen.height_field = mc::HeightFieldBody{
      surface.name, smoothly_upsampled(surface.field, samples_per_pixel(job)), 0, job.edge};
  scene.beam.energy_ev = job.energy_ev;
  scene.beam.spot_nm = job.spot_nm;
  scene.scan.width = surface.field.z_nm.width();
  scene.scan.height = surface.field.z_nm.height();
  scene.scan.pixel_x_nm = surface.field.pitch_x_nm;
  scene.scan.pixel_y_nm = surface.field.pitch_y_nm;
  scene.detectors = job.detectors;
  scene.physics = job.physics;
  out.execution = job.simulation;
  // What the model says itself must not guide its teachers.
  if (teaches) out.estimate = {job.estimate, "off"};
  scene.budget = job.simulation.budget;
  // So that the libraries' chance errors differ from image to image.
  scene.seed = job.simulation.seed + number;
  out.cache = job.cache;
  out.extras.channels = {"z_nm"};
  out.outputs = {output};
  out.command_line = training_command(job);
  title_by_identity(out, "training surface " + surface.name);
  return out;
}

std::string counted(std::size_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

void tell_what_is_there(std::size_t all, std::size_t missing, std::size_t unusable,
                        const fs::path& folder, const NoteCallback& note) {
  if (!note) return;
  const std::size_t found = all - missing;
  if (found > 0)
    note(fmt::format("{} of {} are there already, in {}", found, counted(all, "image"),
                     folder.string()));
  if (unusable > 0)
    note(
        fmt::format("{} there made otherwise, by another build or unfinished, and will be replaced",
                    unusable == 1 ? "1 image is" : fmt::format("{} images are", unusable)));
}

constexpr char there = '+', not_there = '-';

// One letter for each image. The leader decides for a team: other members may see the folder's
// files later.
std::string what_is_missing(const std::vector<SimulateJob>& all, const fs::path& folder,
                            const NoteCallback& note, Team* team) {
  std::string letters;
  together(team, [&] {
    if (!leads(team)) return;
    std::size_t missing = 0, unusable = 0;
    for (const SimulateJob& simulation : all) {
      const bool found = is_finished(simulation);
      letters += found ? there : not_there;
      std::error_code ignored;
      if (!found) ++missing;
      if (!found && fs::exists(simulation.outputs.front(), ignored)) ++unusable;
    }
    tell_what_is_there(all.size(), missing, unusable, folder, note);
  });
  if (team) team->broadcast(letters);
  return letters;
}

mc::Scan scan_of(const TrainingSurface& surface) {
  mc::Scan scan;
  scan.width = surface.field.z_nm.width();
  scan.height = surface.field.z_nm.height();
  return scan;
}

}  // namespace

int samples_per_pixel(const mc::Material& material, double energy_ev, double pixel_nm) {
  const double range_nm = mc::kanaya_okayama_range_nm(material, energy_ev);
  return std::clamp(static_cast<int>(std::ceil(5 * pixel_nm / range_nm)), 1, 8);
}

int samples_per_pixel(const TrainJob& job) {
  return job.fine > 0 ? job.fine : samples_per_pixel(job.material, job.energy_ev, job.pixel_nm);
}

fs::path image_folder(const TrainJob& job) {
  if (!job.images.empty()) return job.images;
  fs::path folder = job.output;
  folder.replace_extension(".training");
  return folder;
}

SimulatedImages simulate_images(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
                                const Reporter& reporter, Team* team, bool whole) {
  SimulatedImages out;
  out.files.resize(surfaces.size());
  const fs::path folder = image_folder(job);
  std::vector<SimulateJob> all;
  std::vector<const TrainingSurface*> shown;
  const std::vector<LearnableKind> kinds = learnable_kinds();
  const auto kind = std::ranges::find(kinds, job.learn.kind, &LearnableKind::name);
  const bool only_judge = kind != kinds.end() && !kind->needs_images;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].has_image()) continue;
    out.files[i] = folder / (surfaces[i].name + ".exr");
    const bool teaches =
        !only_judge && i + static_cast<std::size_t>(job.held_out) < surfaces.size();
    all.push_back(simulation_of(job, surfaces[i], i, teaches, out.files[i]));
    shown.push_back(&surfaces[i]);
  }
  const std::string wanted = what_is_missing(all, folder, reporter.on_note, team);
  std::vector<SimulateJob> missing;
  ManyRuns runs;
  runs.tiles = std::numeric_limits<std::size_t>::max();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (wanted[i] == there) continue;
    const mc::Scan scan = scan_of(*shown[i]);
    const double pixels = static_cast<double>(scan.width) * scan.height;
    missing.push_back(std::move(all[i]));
    runs.weights.push_back(pixels);
    runs.tiles = std::min(runs.tiles, tiles_of(scan));
    runs.pixels = std::max(runs.pixels, pixels);
  }
  out.found = static_cast<int>(wanted.size() - missing.size());
  std::set<std::string> warned;
  runs.make = [&](std::size_t i) { return missing[i]; };
  runs.finished = [&](std::size_t, const std::string&) { ++out.made; };
  runs.folder = folder;
  runs.whole = whole;
  runs.threads = job.simulation.threads;
  runs.things = "pixels";
  runs.reporter = reporter;
  runs.reporter.on_note = {};
  runs.reporter.on_warning = [&](const std::string& warning) {
    if (warned.insert(warning).second) reporter.warn(warning);
  };
  out.runs = run_many(runs, team);
  if (!team || !out.runs.complete) return out;
  together(team, [&] {
    if (!team->leads()) return;
    for (const SimulateJob& made : missing)
      await_file(made.outputs.front(), [&] { return is_finished(made); });
  });
  return out;
}

}  // namespace surf::workflow
