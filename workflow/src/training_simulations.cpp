// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "finished_image.h"
#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/mc/electron_range.h"
#include "training_data.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

SimulateJob simulation_of(const TrainJob& job, const TrainingSurface& surface, std::size_t number,
                          const fs::path& output) {
  SimulateJob out;
  io::SceneFile& scene = out.scene;
  scene.specimen.materials = {job.material};
  scene.specimen.height_field =
      mc::HeightFieldBody{surface.name, smoothly_upsampled(surface.field, samples_per_pixel(job)), 0, job.edge};
  scene.beam.energy_ev = job.energy_ev;
  scene.beam.spot_nm = job.spot_nm;
  scene.scan.width = surface.field.z_nm.width();
  scene.scan.height = surface.field.z_nm.height();
  scene.scan.pixel_x_nm = surface.field.pitch_x_nm;
  scene.scan.pixel_y_nm = surface.field.pitch_y_nm;
  scene.physics = job.physics;
  out.options = job.simulation;
  out.options.seed += number;   // the libraries' own chance errors then differ from image to image
  out.cache = job.cache;
  out.extras.channels = {"z_nm"};
  out.outputs = {output};
  out.command_line = job.command_line;
  title_by_identity(out, "training surface " + surface.name);
  return out;
}

std::string counted(std::size_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

void tell_what_is_there(const std::vector<SimulateJob>& all, std::size_t missing, std::size_t unusable,
                        const fs::path& folder, const NoteCallback& note) {
  if (!note) return;
  const std::size_t found = all.size() - missing;
  if (found > 0) note(fmt::format("{} of {} are there already, in {}", found, counted(all.size(), "image"), folder.string()));
  if (unusable > 0)
    note(fmt::format("{} there made otherwise, by another build or unfinished, and will be replaced",
                     unusable == 1 ? "1 image is" : fmt::format("{} images are", unusable)));
}

}  // namespace

int samples_per_pixel(const TrainJob& job) {
  if (job.fine > 0) return job.fine;
  const double range_nm = mc::kanaya_okayama_range_nm(job.material, job.energy_ev);
  return std::clamp(static_cast<int>(std::ceil(5 * job.pixel_nm / range_nm)), 1, 8);
}

fs::path image_folder(const TrainJob& job) {
  if (!job.images.empty()) return job.images;
  fs::path folder = job.output;
  folder.replace_extension(".training");
  return folder;
}

SimulatedImages simulate_images(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
                                const TrainListener& listener) {
  SimulatedImages out;
  out.files.resize(surfaces.size());
  const fs::path folder = image_folder(job);
  std::vector<SimulateJob> all, missing;
  std::vector<double> pixels_missing;
  std::size_t unusable = 0;
  double total = 0, done_before = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].has_image()) continue;
    out.files[i] = folder / (surfaces[i].name + ".exr");
    all.push_back(simulation_of(job, surfaces[i], i, out.files[i]));
    if (is_finished(all.back())) continue;
    std::error_code ignored;
    if (fs::exists(out.files[i], ignored)) ++unusable;
    missing.push_back(all.back());
    pixels_missing.push_back(static_cast<double>(surfaces[i].field.z_nm.size()));
    total += pixels_missing.back();
  }
  out.found = static_cast<int>(all.size() - missing.size());
  tell_what_is_there(all, missing.size(), unusable, folder, listener.note);
  std::set<std::string> warned;
  const auto warn = [&](const std::string& warning) {
    if (warned.insert(warning).second && listener.warn) listener.warn(warning);
  };
  for (std::size_t i = 0; i < missing.size(); ++i) {
    const SimulateJob& simulation = missing[i];
    const double pixels = pixels_missing[i];
    const auto show = [&](double done, double of) {
      if (listener.pixels && of > 0) listener.pixels(done_before + pixels * done / of, total);
    };
    const bool complete = [&] {
      try {
        return run(simulation, show, listener.cancel, warn, {}, listener.cascades).result.complete;
      } catch (const Interrupted&) {   // before there was anything to keep
        return false;
      }
    }();
    if (!complete) {
      out.complete = false;
      return out;
    }
    done_before += pixels;
    ++out.made;
  }
  return out;
}

}  // namespace surf::workflow
