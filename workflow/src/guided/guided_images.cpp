// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided/guided_images.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surf::workflow {
namespace {

constexpr double least_yield_share = 0.05;  // of the mean: darker pixels do not count for more

}  // namespace

CountImage in_halves(int width, int height,
                     const std::function<PixelCounts(int x, int y)>& counts_at) {
  CountImage halves;
  for (CountHalf& half : halves)
    for (auto* plane : {&half.primaries, &half.sum, &half.squares})
      *plane = Grid<double>(width, height, 0.0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto [n, all, odd] = counts_at(x, y);
      halves[0].primaries(x, y) = static_cast<double>(n - n / 2);
      halves[0].sum(x, y) = static_cast<double>(all.sum - odd.sum);
      halves[0].squares(x, y) = static_cast<double>(all.squares - odd.squares);
      halves[1].primaries(x, y) = static_cast<double>(n / 2);
      halves[1].sum(x, y) = static_cast<double>(odd.sum);
      halves[1].squares(x, y) = static_cast<double>(odd.squares);
    }
  return halves;
}

std::vector<GuidedImage> estimate_detectors(
    const std::vector<std::string>& detectors,
    const std::function<CountImage(std::size_t detector)>& counts_of, const SceneGuides& guides,
    const GuidedOptions& options) {
  const std::size_t count = detectors.size();
  const std::size_t all = guides.detectors.empty() ? count : 2 * count;
  std::size_t done = 0;
  const auto estimate = [&](std::size_t d, const std::vector<Guide>& by) {
    GuidedOptions own = options;
    own.watch = options.watch.part(static_cast<double>(done) / static_cast<double>(all),
                                   static_cast<double>(done + 1) / static_cast<double>(all));
    ++done;
    return estimate_guided(counts_of(d), by, own);
  };
  std::vector<GuidedImage> first;
  for (std::size_t d = 0; d < count; ++d) first.push_back(estimate(d, guides.of(detectors[d])));
  if (guides.detectors.empty()) return first;
  std::vector<GuidedImage> images;
  for (std::size_t d = 0; d < count; ++d) {
    std::vector<Guide> by = guides.of(detectors[d]);
    for (std::size_t other = 0; other < count; ++other)
      if (other != d && std::ranges::count(guides.detectors, detectors[other]) > 0)
        by.push_back({detectors[other], first[other].halves[1], false, first[other].halves[0]});
    images.push_back(estimate(d, by));
  }
  return images;
}

std::vector<GuidedImage> estimate_images(const mc::SimulationResult& result,
                                         const SceneGuides& guides, int threads,
                                         const Watch& watch) {
  std::vector<std::string> names;
  for (const mc::Detector& detector : result.detectors) names.push_back(detector.name);
  return estimate_detectors(
      names,
      [&](std::size_t d) {
        return in_halves(result.pixels.width(), result.pixels.height(), [&](int x, int y) {
          if (x == 0) result.release();
          return PixelCounts{result.pixels(x, y).primaries, result.counts[d](x, y),
                             result.odd_counts[d](x, y)};
        });
      },
      guides,
      {.region = guides.region,
       .library_cascades = static_cast<double>(result.library_cascades),
       .threads = threads,
       .watch = watch});
}

GuidedGain gain_of(const GuidedImage& image, const Grid<double>& plain_error) {
  double pixels = 0, sum = 0, guided = 0, plain = 0;
  for (std::size_t i = 0; i < image.mean.size(); ++i)
    if (image.radius_px.data()[i] > 0) pixels += 1, sum += image.mean.data()[i];
  if (!(sum > 0)) return {};
  const double least = least_yield_share * sum / pixels;
  for (std::size_t i = 0; i < image.mean.size(); ++i) {
    if (!(image.radius_px.data()[i] > 0)) continue;
    const double yield = std::max(image.mean.data()[i], least);
    guided += std::pow(image.error.data()[i] / yield, 2);
    plain += std::pow(plain_error.data()[i] / yield, 2);
  }
  return {std::sqrt(guided / pixels), std::sqrt(plain / pixels)};
}

std::vector<GuidedGain> gains_of(const mc::SimulationResult& result,
                                 const std::vector<GuidedImage>& images) {
  std::vector<GuidedGain> gains;
  Grid<double> plain(result.pixels.width(), result.pixels.height());
  for (std::size_t d = 0; d < images.size(); ++d) {
    for (int y = 0; y < plain.height(); ++y)
      for (int x = 0; x < plain.width(); ++x)
        plain(x, y) = result.yield(d, x, y).standard_error / result.detectors[d].efficiency;
    gains.push_back(gain_of(images[d], plain));
  }
  return gains;
}

void show_guided(const mc::SimulationResult& result, const std::vector<GuidedImage>& images,
                 ImageRows& image) {
  struct Shown {
    const Grid<double>* values = nullptr;  // null: the channel stays as it is
    const Grid<double>* radius_px = nullptr;
    double efficiency = 1;
  };
  std::vector<Shown> shown(image.head.channels.size());
  for (std::size_t c = 0; c < shown.size(); ++c)
    for (std::size_t d = 0; d < images.size(); ++d) {
      const std::string &name = image.head.channels[c].name, &own = result.detectors[d].name;
      if (name != own && name != own + ".stderr") continue;
      shown[c] = {name == own ? &images[d].mean : &images[d].error, &images[d].radius_px,
                  result.detectors[d].efficiency};
    }
  image.read = [plain = std::move(image.read), shown = std::move(shown)](std::size_t channel, int y,
                                                                         std::span<float> row) {
    plain(channel, y, row);
    const Shown& guided = shown[channel];
    if (!guided.values) return;
    for (int x = 0; x < static_cast<int>(row.size()); ++x)
      if ((*guided.radius_px)(x, y) > 0)
        row[static_cast<std::size_t>(x)] =
            static_cast<float>((*guided.values)(x, y) * guided.efficiency);
  };
}

}  // namespace surf::workflow
