// SPDX-License-Identifier: GPL-3.0-or-later
#include "training_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/sem/training_surfaces.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr double same_pitch = 1e-3;  // relative; image models demand the same
constexpr double most_coarse = 2;    // times the model's pixel size

bool is_pitch(double pitch_nm, double wanted_nm) {
  return std::abs(pitch_nm - wanted_nm) <= same_pitch * wanted_nm;
}

std::string hash_of(const HeightField& field) {
  return io::sha256_of(std::as_bytes(std::span(field.z_nm.data())));
}

/// The stem of a file name: "scan" for "folder/scan.gwy".
std::string stem_of(const std::string& name) {
  const std::string stem = fs::path(name).stem().string();
  return stem.empty() ? "surface" : stem;
}

std::string unique(const std::string& name, std::set<std::string>& taken) {
  std::string candidate = name;
  for (int number = 2; !taken.insert(candidate).second; ++number)
    candidate = fmt::format("{}-{}", name, number);
  return candidate;
}

HeightField at_pixel(const TrainingInput& input, double pixel_nm, const NoteCallback& note) {
  const HeightField& field = input.field;
  const auto& valid = field.valid.data();
  if (std::find(valid.begin(), valid.end(), 0) != valid.end())
    throw InvalidInput(input.name, "it has missing samples", "'semsurf clean' fills them");
  if (is_pitch(field.pitch_x_nm, pixel_nm) && is_pitch(field.pitch_y_nm, pixel_nm)) return field;
  const double coarsest = std::max(field.pitch_x_nm, field.pitch_y_nm);
  if (coarsest > most_coarse * pixel_nm)
    throw InvalidInput(input.name,
                       fmt::format("its samples are {} apart, the model's pixels are {}",
                                   format_length(coarsest), format_length(pixel_nm)),
                       fmt::format("What is in between is not known: use "
                                   "`training.pixel_size={}nm`, or leave the file out",
                                   format_exact(coarsest)));
  HeightField out = resampled(field, pixel_nm);
  if (note)
    note(fmt::format("{}: {} x {} samples of {} are resampled to {} x {} of {}", input.name,
                     field.z_nm.width(), field.z_nm.height(), format_length(field.pitch_x_nm),
                     out.z_nm.width(), out.z_nm.height(), format_length(pixel_nm)));
  return out;
}

// Electrons counted in a pixel say little of its own standard error: few by chance look precise,
// and would weigh more. The mean variance of the 25 around is nearly free of that.
Grid<float> even_errors(const Grid<float>& errors, const Mask& used) {
  constexpr int reach = 2;
  const int w = errors.width(), h = errors.height();
  Grid<float> out(w, h);
  double smallest = HUGE_VAL;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      double sum = 0;
      int count = 0;
      for (int v = std::max(y - reach, 0); v <= std::min(y + reach, h - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, w - 1); ++u)
          if (used(u, v)) sum += double(errors(u, v)) * errors(u, v), ++count;
      if (count > 0) out(x, y) = static_cast<float>(std::sqrt(sum / count));
      if (out(x, y) > 0) smallest = std::min<double>(smallest, out(x, y));
    }
  if (!std::isfinite(smallest)) return {};
  // No electrons were counted.
  for (float& error : out.data()) error = std::max(error, static_cast<float>(smallest));
  return out;
}

}  // namespace

int own_surfaces(const TrainJob& job, bool needs_images) {
  if (!job.inputs.empty()) return 0;
  return job.surfaces.value_or(needs_images ? usual_training_surfaces : 0);
}

std::vector<TrainingSurface> gather_surfaces(const TrainJob& job, int own,
                                             const NoteCallback& note) {
  std::vector<TrainingSurface> surfaces;
  std::set<std::string> taken;
  for (const TrainingInput& input : job.inputs) {
    HeightField field = at_pixel(input, job.pixel_nm, note);
    std::string hash = input.sha256.empty() ? hash_of(field) : input.sha256;
    surfaces.push_back({unique(stem_of(input.name), taken), std::move(field), std::move(hash),
                        input.image, input.pixels});
  }
  if (own == 0) return surfaces;
  for (NamedSurface& made :
       training_surfaces({job.pixel_nm, job.surface_px, own, job.simulation.seed})) {
    std::string hash = hash_of(made.field);
    surfaces.push_back({made.name, std::move(made.field), std::move(hash), {}});
  }
  return surfaces;
}

std::vector<std::string> channels_of(const TrainJob& job) {
  if (!job.signal.empty()) return {"signal"};
  std::vector<std::string> names;
  for (const mc::Detector& d : mc::default_detectors()) names.push_back(d.name);
  for (const mc::Detector& d : job.detectors) names.push_back(d.name);
  return names;
}

TrainingImage read_training_image(const TrainingSurface& surface, const fs::path& file,
                                  const TrainJob& job) {
  const Image image = surface.pixels ? *surface.pixels : io::read_image(file);
  const std::string subject =
      surface.pixels ? fmt::format("the image of {}", surface.name) : file.string();
  const HeightField& field = surface.field;
  const int w = field.z_nm.width(), h = field.z_nm.height();
  if (image.width() != w || image.height() != h)
    throw InvalidInput(
        subject,
        fmt::format("it has {} x {} pixels, the surface {} {} x {} samples", image.width(),
                    image.height(), surface.name, w, h),
        "Give an image with one pixel on each sample of the surface: crop or register it first");
  const bool simulated = job.signal.empty();
  if (simulated &&
      (!is_pitch(image.pitch_x_nm, job.pixel_nm) || !is_pitch(image.pitch_y_nm, job.pixel_nm)))
    throw InvalidInput(subject,
                       fmt::format("its pixels are {}, the model's {}",
                                   format_length(image.pitch_x_nm), format_length(job.pixel_nm)),
                       "Give an image of the model's pixel size");
  TrainingImage out;
  out.name = surface.name;
  out.field = field;
  out.edge = job.edge;
  out.used = Mask(w, h, 1);
  if (const Channel* valid = image.find("valid"))
    for (std::size_t i = 0; i < out.used.size(); ++i)
      out.used.data()[i] = valid->values.data()[i] != 0;
  const std::vector<std::string> wanted = simulated ? channels_of(job) : std::vector{job.signal};
  for (const std::string& name : wanted) {
    const Channel* channel = image.find(name);
    if (!channel)
      throw FileError(
          subject, fmt::format("it has no channel '{}'", name),
          simulated ? "Give an image with SE, BSE and every one of `simulation.detectors`, or "
                      "`training.signal` for that of a microscope"
                    : "'semsurf info' lists its channels: `training.signal=FILE:CHANNEL`");
    for (std::size_t i = 0; i < out.used.size(); ++i)
      if (!std::isfinite(channel->values.data()[i])) out.used.data()[i] = 0;
    out.images.push_back(channel->values);
  }
  for (const std::string& name : wanted) {
    const Channel* errors = image.find(name + ".stderr");
    if (!errors) continue;
    for (std::size_t i = 0; i < out.used.size(); ++i)
      if (!std::isfinite(errors->values.data()[i])) out.used.data()[i] = 0;
  }
  if (std::find(out.used.data().begin(), out.used.data().end(), 1) == out.used.data().end())
    throw InvalidInput(subject, "none of its pixels has a value", "Give an image of the surface");
  for (const std::string& name : wanted)
    if (const Channel* errors = image.find(name + ".stderr"))
      if (Grid<float> even = even_errors(errors->values, out.used); !even.empty())
        out.standard_errors.push_back(std::move(even));
  if (out.standard_errors.size() < wanted.size()) out.standard_errors.clear();
  return out;
}

}  // namespace surf::workflow
