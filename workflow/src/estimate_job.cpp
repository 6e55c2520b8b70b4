// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/estimate_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "common_parameters.h"
#include "guided/guide_model.h"
#include "guided/guided_images.h"
#include "guided/scene_guides.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/overlaps.h"
#include "surf/workflow/step_record.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr float most_counts = 1e15f;
constexpr const char* endings[] = {".sum", ".squares", ".odd_sum", ".odd_squares"};

/// Names of the detectors whose counts an image has.
std::vector<std::string> detectors_of(const Image& image) {
  std::vector<std::string> names;
  for (const Channel& channel : image.channels) {
    if (!channel.name.ends_with(".odd_sum")) continue;
    const std::string name = channel.name.substr(0, channel.name.size() - 8);
    if (std::ranges::all_of(endings, [&](const char* ending) { return image.find(name + ending); }))
      names.push_back(name);
  }
  return names;
}

/// Counts of a detector, pixel by pixel. Refers to `image`.
std::function<PixelCounts(int x, int y)> counts_of(const Image& image,
                                                   const std::string& detector) {
  const auto whole = [&image](const std::string& name) {
    const Grid<float>& values = image.find(name)->values;
    for (const float value : values.data())
      if (!(value >= 0 && value <= most_counts))
        throw InvalidInput("channel " + name, fmt::format("a pixel is {}", value),
                           "Counts are whole numbers from 0 on, as 'semsurf simulate' writes them");
    return [&values](int x, int y) { return static_cast<std::int64_t>(values(x, y)); };
  };
  return [electrons = whole("electrons"), sum = whole(detector + ".sum"),
          squares = whole(detector + ".squares"), odd_sum = whole(detector + ".odd_sum"),
          odd_squares = whole(detector + ".odd_squares")](int x, int y) {
    return PixelCounts{
        electrons(x, y), {sum(x, y), squares(x, y)}, {odd_sum(x, y), odd_squares(x, y)}};
  };
}

double number_in(const Image& image, const std::string& key, double otherwise) {
  const auto found = image.metadata.find(key);
  if (found == image.metadata.end()) return otherwise;
  char* end = nullptr;
  const double value = std::strtod(found->second.c_str(), &end);
  return end != found->second.c_str() && std::isfinite(value) ? value : otherwise;
}

/// Of a detector, as the image's record describes it; 1 where it does not.
double efficiency_of(const Image& image, const std::string& detector) {
  for (const auto& [name, text] : image.metadata)
    if (name.starts_with("detector."))
      for (const mc::Detector& described : mc::parse_detectors(text, "metadata " + name))
        if (described.name == detector) return described.efficiency;
  return 1;
}

bool shows_surface(const Image& image) {
  return std::ranges::all_of(
      std::initializer_list<const char*>{"z_nm", "normal.x", "normal.y", "normal.z"},
      [&](const char* name) { return image.find(name) != nullptr; });
}

/// Adds what a view has and an image may lack.
Image view_of(const Image& image) {
  Image view;
  view.placement() = image.placement();
  for (const char* name : {"z_nm", "normal.x", "normal.y", "normal.z", "material", "valid"}) {
    if (const Channel* const channel = image.find(name)) view.channels.push_back(*channel);
    else view.channels.push_back({name, "1", Grid<float>(image.width(), image.height(), 1.0f)});
  }
  return view;
}

SceneGuides guides_in(const Image& image, const EstimateJob& job,
                      const std::vector<std::string>& detectors, const Watch& watch) {
  SceneGuides guides;
  mc::Beam beam;
  beam.tilt_deg = number_in(image, "beam.tilt_deg", 0);
  beam.azimuth_deg = number_in(image, "beam.azimuth_deg", 0);
  beam.spot_nm = number_in(image, "beam.spot_nm", 0);
  mc::validate(beam);
  if (shows_surface(image)) {
    const SeenSurface surface = seen_surface(view_of(image), beam, guides.region);
    guides.shape = shape_guides(surface, job.threads, watch);
    if (!job.model.empty()) {
      GuideModel model;
      model.model = make_model(io::read_model(job.model));
      guides.predicted = predicted_guides(model, surface, job.threads, watch);
    }
  } else if (!job.model.empty()) {
    throw UsageError(
        "`estimate.model`", "the image has no heights that it could predict from",
        "Make it by 'semsurf simulate --channels counts,electrons,z_nm,normal,material'");
  } else if (const Channel* const valid = image.find("valid")) {
    guides.region = Grid<int>(image.width(), image.height(), 0);
    for (std::size_t i = 0; i < guides.region.size(); ++i)
      guides.region.data()[i] = valid->values.data()[i] > 0 ? 0 : -1;
  }
  for (const std::string& name : job.guides) {
    const Channel* const channel = image.find(name);
    if (!channel)
      throw UsageError("`estimate.guides`", fmt::format("the image has no channel '{}'", name),
                       "'semsurf info IMAGE' lists its channels");
    if (std::ranges::count(detectors, name) > 0) {
      guides.detectors.push_back(name);
      continue;
    }
    Guide guide{name, Grid<double>(image.width(), image.height(), 0.0)};
    std::ranges::copy(channel->values.data(), guide.values.data().begin());
    guides.shape.push_back(std::move(guide));
  }
  return guides;
}

Channel& channel_of(Image& image, const std::string& name) {
  for (Channel& channel : image.channels)
    if (channel.name == name) return channel;
  image.channels.push_back({name, "1", Grid<float>(image.width(), image.height(), 0.0f)});
  return image.channels.back();
}

void check_outputs(const EstimateJob& job, const Image& like) {
  std::vector<io::FileUse> outputs, inputs;
  if (!job.input.empty()) inputs.push_back({"IMAGE", job.input, {}});
  if (!job.model.empty()) inputs.push_back({"`estimate.model`", job.model, {}});
  for (const fs::path& output : job.outputs) outputs.push_back({"`output`", output, {}});
  io::refuse_overlaps(inputs, outputs);
  for (const fs::path& output : job.outputs) {
    io::check_image_target(output, &like, {job.png_channel});
    io::check_writable(output);
  }
}

}  // namespace

void describe(ParameterVisitor& visit, EstimateJob& job) {
  describe_names(
      visit, job.guides,
      {.name = "estimate.guides",
       .help = "More channels of the image that guide, or detectors whose images guide those "
               "of the others, each half of the electrons by the other",
       .otherwise = "none"});
  describe_path(visit, job.model,
                {.name = "estimate.model",
                 .help = "Fast model whose prediction guides, as 'semsurf train' writes it; the "
                         "image must have z_nm and normal",
                 .otherwise = "none",
                 .file = FileRole::read});
  describe_images(visit, job.outputs, "Image to write: EXR, TIFF, PNG, VTI");
  visit(job.png_channel, {.name = "output.png_channel",
                          .help = "Channel that PNG files show",
                          .otherwise = "the first",
                          .form = "NAME"});
  describe_threads(visit, job.threads);
}

EstimateSummary run(const EstimateJob& job, const Reporter& reporter) {
  const Watch watch = reporter.watch();
  EstimateSummary summary;
  summary.image = job.input.empty() ? job.image : io::read_image(job.input);
  Image& image = summary.image;
  const std::string subject = job.input.empty() ? "IMAGE" : job.input.string();
  summary.detectors = detectors_of(image);
  if (summary.detectors.empty() || !image.find("electrons"))
    throw InvalidInput(
        subject, "it has no counts to estimate from",
        "Make it by 'semsurf simulate --channels counts,electrons,z_nm,normal,material'");
  for (const std::string& name : summary.detectors)  // all channels before any of them is used
    for (const char* ending : {"", ".stderr", ".radius"}) channel_of(image, name + ending);
  check_outputs(job, image);
  const SceneGuides guides = guides_in(image, job, summary.detectors, watch.part(0, 0.1));
  for (const Guide& guide : guides.predicted) summary.guides.push_back("predicted " + guide.name);
  for (const Guide& guide : guides.shape) summary.guides.push_back(guide.name);
  summary.guides.insert(summary.guides.end(), guides.detectors.begin(), guides.detectors.end());
  const double cascades = number_in(image, "library.cascades", 0);
  std::vector<fs::path> inputs;
  if (!job.input.empty()) inputs.push_back(job.input);
  if (!job.model.empty()) inputs.push_back(job.model);
  EstimateJob said;
  said.guides = job.guides;
  const auto record = step_record("estimate", record_of(said), inputs);
  const std::vector<GuidedImage> images = estimate_detectors(
      summary.detectors,
      [&](std::size_t d) {
        return in_halves(image.width(), image.height(), counts_of(image, summary.detectors[d]));
      },
      guides,
      {.region = guides.region,
       .library_cascades = std::max(0.0, cascades),
       .threads = job.threads,
       .watch = watch.part(0.1, 1)});
  for (std::size_t d = 0; d < summary.detectors.size(); ++d) {
    const std::string& name = summary.detectors[d];
    const auto counts_at = counts_of(image, name);
    const GuidedImage& guided = images[d];
    const double efficiency = efficiency_of(image, name);
    Grid<float>&mean = channel_of(image, name).values,
    &error = channel_of(image, name + ".stderr").values,
    &radius = channel_of(image, name + ".radius").values;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      radius.data()[i] = static_cast<float>(guided.radius_px.data()[i]);
      if (!(guided.radius_px.data()[i] > 0)) continue;  // as it was
      mean.data()[i] = static_cast<float>(efficiency * guided.mean.data()[i]);
      error.data()[i] = static_cast<float>(efficiency * guided.error.data()[i]);
    }
    Grid<double> plain_error(image.width(), image.height());
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        const PixelCounts counts = counts_at(x, y);
        plain_error(x, y) = mc::estimate(counts.primaries, counts.all).standard_error;
      }
    summary.gains.push_back(gain_of(guided, plain_error));
  }
  for (const auto& [key, value] : record)
    if (key != "semsurf.version") image.metadata["estimate." + key] = value;
  image.metadata["simulation.estimate"] = "guided";
  watch.check();
  for (const fs::path& output : job.outputs) io::write_image(output, image, {job.png_channel});
  return summary;
}

}  // namespace surf::workflow
