// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/fit_facet_network.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "network_engine.h"
#include "network_trainer.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/sem/fit_filter_bank.h"

namespace surf {
namespace {

constexpr const char* subject = "training";
// Relative to the range. The far bands represent surfaces that shadow and catch electrons outside
// the material, which the range does not limit. Without them level ground was 2 % too dark where
// training surfaces are crowded.
constexpr double widest_sigma = 0.65, sky_limits[] = {0, 0.13, 0.33, 0.67, 1.33, 2.67, 5.33};
constexpr std::size_t fewest_scales = 4;
constexpr double farthest_px = 128;  // of the sky; fields are continued by as much

}  // namespace

void validate(const FacetNetworkFitOptions& o) {
  const auto refuse = [](const char* name, double value, const char* range) {
    throw UsageError("training", fmt::format("{} is {}", name, value),
                     fmt::format("Give {}", range));
  };
  if (!(o.range_nm > 0 && o.range_nm < 1e6))
    refuse("the range of electrons", o.range_nm, "a length above 0");
  if (o.hidden.size() > 3)
    refuse("the number of hidden layers", static_cast<double>(o.hidden.size()), "0 to 3");
  for (const int units : o.hidden)
    if (units < 1 || units > 256) refuse("the number of hidden units", units, "1 to 256");
  if (o.iterations < 1 || o.iterations > 100000)
    refuse("the number of iterations", o.iterations, "1 to 100,000");
  if (!(o.decay >= 0 && o.decay < 1e6)) refuse("the decay", o.decay, "a number not below 0");
  if (!(o.tolerance >= 0 && o.tolerance <= 1)) refuse("the tolerance", o.tolerance, "0 to 1");
}

namespace {

/// The used pixels: inputs of the network, signals in units of the channels' means, and the
/// variance of the noise as a share of the mean signal, image by image.
struct Lesson {
  TrainerData data;
  std::vector<double> means, scales;  // of the inputs: mean to subtract, scale to divide by
};

double pixel_of(const std::vector<TrainingImage>& images) {
  const double pixel = images.front().field.pitch_x_nm;
  for (const TrainingImage& image : images) {
    const HeightField& f = image.field;
    if (std::abs(f.pitch_x_nm - pixel) > 1e-3 * pixel ||
        std::abs(f.pitch_y_nm - pixel) > 1e-3 * pixel)
      throw InvalidInput(
          image.name,
          fmt::format("it has pixels of {:.4g} x {:.4g} nm, the first image {:.4g} nm",
                      f.pitch_x_nm, f.pitch_y_nm, pixel),
          "A network is learnt for one size of square pixels: resample the surface");
  }
  return pixel;
}

void add_inputs(const FacetNetworkParameters& parameters, const TrainingImage& image,
                double pixel_nm, int threads, int inputs, std::vector<float>& out) {
  ModelOptions options;
  options.edge = image.edge;
  options.threads = threads;
  const NetworkEngine<float> engine(parameters, pixel_nm, options);
  const int width = image.field.z_nm.width();
  const std::size_t first = out.size();
  out.resize(first + image.field.z_nm.size() * inputs);
  engine.inputs(image.field.z_nm, [&](const facet::Block& block, int columns, const float* in) {
    for (int y = 0; y < block.rows; ++y)
      for (int x = 0; x < block.width; ++x) {
        float* const to = out.data() + first +
                          (static_cast<std::size_t>(block.y + y) * width + block.x + x) * inputs;
        for (int i = 0; i < inputs; ++i)
          to[i] = in[(static_cast<std::size_t>(y) * inputs + i) * columns + x];
      }
  });
}

bool is_used(const TrainingImage& image, std::size_t i) { return image.used.includes(i); }

Lesson gather(const std::vector<TrainingImage>& images, const FacetNetworkParameters& parameters,
              double pixel_nm, const FacetNetworkFitOptions& options,
              std::vector<double>& signal_means) {
  const int inputs = network_inputs(parameters),
            channels = static_cast<int>(parameters.channels.size());
  Lesson lesson;
  TrainerData& data = lesson.data;
  data.inputs = inputs;
  data.outputs = channels;
  std::vector<double> sums(channels);
  for (const TrainingImage& image : images) {
    options.watch.check();
    std::vector<float> all;
    add_inputs(parameters, image, pixel_nm, options.threads, inputs, all);
    const std::size_t first = data.y.size() / channels;
    for (std::size_t i = 0; i < image.field.z_nm.size(); ++i) {
      if (!is_used(image, i)) continue;
      data.x.insert(data.x.end(), all.begin() + static_cast<std::ptrdiff_t>(i) * inputs,
                    all.begin() + static_cast<std::ptrdiff_t>(i + 1) * inputs);
      for (int c = 0; c < channels; ++c) {
        data.y.push_back(image.images[c].data()[i]);
        sums[c] += image.images[c].data()[i];
      }
    }
    const std::size_t end = data.y.size() / channels;
    for (int c = 0; c < channels; ++c) {
      double noise = 0, signal = 0;
      if (!image.standard_errors.empty())
        for (std::size_t i = 0; i < image.field.z_nm.size(); ++i)
          if (is_used(image, i)) {
            const double e = image.standard_errors[c].data()[i];
            noise += e * e;
            signal += image.images[c].data()[i];
          }
      data.noise.push_back(signal > 0 ? noise / signal : 0);
    }
    for (std::size_t i = first; i < end; ++i)
      data.image.push_back(static_cast<int>(&image - images.data()));
  }
  const std::size_t pixels = data.image.size();
  if (pixels == 0) throw InvalidInput(subject, "no pixel is used", "Give images with some");
  for (int c = 0; c < channels; ++c) {
    const double mean = sums[c] / static_cast<double>(pixels);
    if (!(mean > 0))
      throw InvalidInput(
          subject,
          fmt::format("the mean of channel {} is {:.4g}", parameters.channels[c].name, mean),
          "A network learns signals above 0: add an offset to the image");
    signal_means.push_back(mean);
    for (std::size_t i = 0; i < images.size(); ++i) data.noise[i * channels + c] /= mean;
    for (std::size_t i = 0; i < pixels; ++i)
      data.y[i * channels + c] = static_cast<float>(data.y[i * channels + c] / mean);
  }
  data.has_noise = !images.front().standard_errors.empty();
  data.tolerance = options.tolerance;

  lesson.means.resize(inputs);
  lesson.scales.resize(inputs);
  for (int i = 0; i < inputs; ++i) {
    double sum = 0, square = 0;
    for (std::size_t p = 0; p < pixels; ++p) sum += data.x[p * inputs + i];
    const double mean = sum / static_cast<double>(pixels);
    for (std::size_t p = 0; p < pixels; ++p) square += std::pow(data.x[p * inputs + i] - mean, 2);
    const double deviation = std::sqrt(square / static_cast<double>(pixels));
    lesson.means[i] = mean;
    // An input that never varies contains no information; the network ignores it.
    lesson.scales[i] = deviation > 1e-6 ? 1 / deviation : 0;
    for (std::size_t p = 0; p < pixels; ++p)
      data.x[p * inputs + i] =
          static_cast<float>((data.x[p * inputs + i] - mean) * lesson.scales[i]);
  }
  return lesson;
}

double normal(RandomStream& random) {
  return std::sqrt(-2 * std::log(random.uniform())) * std::cos(2 * M_PI * random.uniform());
}

std::vector<DenseLayer> first_guess(const std::vector<int>& sizes, std::uint64_t seed) {
  std::vector<DenseLayer> layers;
  for (std::size_t l = 0; l + 1 < sizes.size(); ++l) {
    DenseLayer& layer = layers.emplace_back();
    layer.inputs = sizes[l];
    layer.outputs = sizes[l + 1];
    RandomStream random(seed, l, 0);
    const bool last = l + 2 == sizes.size();
    for (int i = 0; i < layer.inputs * layer.outputs; ++i)
      layer.weights.push_back(normal(random) / std::sqrt(layer.inputs));
    for (int i = 0; i < layer.outputs; ++i) layer.biases.push_back(last ? 0 : 0.3 * normal(random));
  }
  return layers;
}

/// Converts the first layer from shifted and scaled inputs to the original inputs.
void fold(const Lesson& lesson, DenseLayer& layer) {
  for (int o = 0; o < layer.outputs; ++o)
    for (int i = 0; i < layer.inputs; ++i) {
      double& weight = layer.weights[static_cast<std::size_t>(o) * layer.inputs + i];
      weight *= lesson.scales[i];
      layer.biases[o] -= weight * lesson.means[i];
    }
}

}  // namespace

std::vector<FacetScale> network_scales(double pixel_nm, double range_nm) {
  std::vector<FacetScale> scales = thesis_scales();
  while (scales.size() > fewest_scales &&
         scales.back().sigma_px * pixel_nm > widest_sigma * range_nm)
    scales.pop_back();
  return scales;
}

std::vector<double> network_sky_edges(double pixel_nm, double range_nm) {
  std::vector<double> edges;
  for (const double limit : sky_limits) {
    edges.push_back(std::min(limit * range_nm, farthest_px * pixel_nm));
    if (edges.back() == farthest_px * pixel_nm) break;
  }
  return edges;
}

FacetNetworkFit fit_facet_network(const std::vector<TrainingImage>& images,
                                  const std::vector<std::string>& channels,
                                  const FacetNetworkFitOptions& options) {
  validate(options);
  validate(images);
  const double pixel_nm = pixel_of(images);
  FacetNetworkFit fit;
  FacetNetworkParameters& p = fit.parameters;
  p.scales = options.scales.empty() ? network_scales(pixel_nm, options.range_nm) : options.scales;
  p.sky_edges_nm = options.sky_edges_nm.empty() ? network_sky_edges(pixel_nm, options.range_nm)
                                                : options.sky_edges_nm;
  p.sided = options.sided;
  for (const std::string& name : channels) p.channels.push_back({name, 1});
  if (images.front().images.size() != channels.size())
    throw InvalidInput(subject,
                       fmt::format("there are {} images of each surface for {} channels",
                                   images.front().images.size(), channels.size()),
                       "Name one channel for each");

  std::vector<double> signal_means;
  const Lesson lesson = gather(images, p, pixel_nm, options, signal_means);
  std::vector<int> sizes{lesson.data.inputs};
  sizes.insert(sizes.end(), options.hidden.begin(), options.hidden.end());
  sizes.push_back(lesson.data.outputs);
  p.layers = first_guess(sizes, options.seed);
  const TrainerResult result = train_network(
      lesson.data, {options.iterations, options.decay, options.threads, options.watch}, p.layers);
  fold(lesson, p.layers.front());
  for (std::size_t c = 0; c < channels.size(); ++c) p.channels[c].scale = signal_means[c];
  fit.cost = result.cost;
  fit.iterations = result.iterations;

  std::size_t numbers = 0;
  for (const DenseLayer& layer : p.layers) numbers += layer.weights.size() + layer.biases.size();
  const std::size_t pixels = lesson.data.image.size();
  if (pixels < 20 * numbers)
    fit.warnings.push_back(
        fmt::format("{} pixels are few for a network of {} numbers: it may have learnt their "
                    "noise. Give more or larger images, or fewer hidden units",
                    pixels, numbers));
  ModelScope scope;
  scope.pixel_nm = pixel_nm;
  fit.residuals = residuals_of(*make_facet_network(scope, p), images, options.threads);
  return fit;
}

}  // namespace surf
