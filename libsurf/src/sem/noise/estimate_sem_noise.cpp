// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/estimate_sem_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "noise_line.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double cut = 3.5;                     // in standard errors from the line
constexpr double most_saturated = 0.005;        // share of a block's pixels
constexpr double core_share = 0.3;              // share of the blocks that locates the cluster
constexpr double lower_cut = 4, upper_cut = 1;  // standard deviations of slow shares
constexpr int wanted_blocks = 20;
constexpr int least_blocks = 5;

double middle(std::vector<double> values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, at);
  return *at;
}

/// The class of a block.
enum Flatness : char { structured, flat, typical };

struct Crowd {
  double centre = 0, deviation = 0;
};

/// Flat blocks cluster at the slow share of the noise; blocks with structure lie above. The cluster
/// is located at the narrowest interval with a given share of all blocks. Its width is estimated
/// from the blocks below its centre.
Crowd find_crowd(const std::vector<double>& sorted) {
  const std::size_t n = sorted.size();
  const std::size_t core =
      std::clamp<std::size_t>(static_cast<std::size_t>(core_share * static_cast<double>(n)),
                              std::min<std::size_t>(n, 4), n);
  std::size_t best = 0;
  for (std::size_t i = 0; i + core <= n; ++i)
    if (sorted[i + core - 1] - sorted[i] < sorted[best + core - 1] - sorted[best]) best = i;
  Crowd crowd{sorted[best + core / 2], 0};
  for (int i = 0; i < 5; ++i) {
    std::vector<double> below, near;
    for (const double share : sorted)
      if (share <= crowd.centre) below.push_back(crowd.centre - share);
    crowd.deviation = std::max(1.4826 * middle(below), 1e-6);
    for (const double share : sorted)
      if (std::fabs(share - crowd.centre) <= 1.5 * crowd.deviation) near.push_back(share);
    crowd.centre = middle(near);
  }
  return crowd;
}

/// Blocks below the upper cut are flat. The typical ones among them lie within the same distance on
/// either side of the cluster's centre; the others have too little correlation.
std::vector<char> choose_flat(const std::vector<FlatSample>& samples, bool& clear) {
  std::vector<double> sorted;
  for (const FlatSample& s : samples)
    if (s.squares > 0) sorted.push_back(slow_share(s));
  std::vector<char> chosen(samples.size(), structured);
  if (sorted.empty()) return chosen;
  std::ranges::sort(sorted);
  const Crowd crowd = find_crowd(sorted);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double from = (slow_share(samples[i]) - crowd.centre) / crowd.deviation;
    if (samples[i].squares > 0 && from >= -lower_cut && from <= upper_cut)
      chosen[i] = from >= -upper_cut ? typical : flat;
  }
  // The slow share of white noise scatters by sqrt(2 * 3.46 / n), relatively; 3.46 is the sum of
  // the squared weights in `slow_share` except the first.
  const double expected =
      crowd.centre * std::sqrt(2 * 3.46 / static_cast<double>(samples.front().pixels));
  clear = crowd.deviation < 2.5 * expected;
  return chosen;
}

Mask unsaturated(const PlacedImage& image, const Saturation& saturated) {
  Mask good(image.values.width(), image.values.height(), 1);
  for (std::size_t i = 0; i < good.size(); ++i)
    good.data()[i] = image.valid.includes(i) && !saturated(image.values.data()[i]);
  return good;
}

/// The number of pixels that the mask includes.
std::int64_t count(const Mask& mask, const PixelRectangle& r) {
  std::int64_t n = 0;
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) n += mask.includes(x, y);
  return n;
}

std::int64_t area(const PixelRectangle& r) { return std::int64_t{r.x1 - r.x0} * (r.y1 - r.y0); }

FlatSamples blocks_of(const PlacedImage& image, const Mask& good, int side, int degree) {
  static const Mask all;
  FlatSamples blocks(image.values, all, degree);
  for (int y = 0; y + side <= image.values.height(); y += side)
    for (int x = 0; x + side <= image.values.width(); x += side) {
      const PixelRectangle r{x, y, x + side, y + side};
      const double saturated = static_cast<double>(area(r) - count(good, r));
      if (count(image.valid, r) == area(r) &&
          saturated <= most_saturated * static_cast<double>(area(r)))
        blocks.add(r);
    }
  return blocks;
}

struct Chosen {
  FlatSamples flat;
  std::vector<char> used;  // Flatness
};

/// Chooses the largest size of blocks at which enough blocks are flat.
Chosen find_flat(const PlacedImage& image, const Mask& good, const SemNoiseOptions& o,
                 SemNoiseEstimate& e) {
  const std::vector<int> sides =
      o.block_px ? std::vector<int>{o.block_px} : std::vector<int>{16, 12, 8};
  bool any = false;
  for (const int side : sides) {
    Chosen c{blocks_of(image, good, side, o.degree), {}};
    any = any ||
          std::ranges::any_of(c.flat.samples, [](const FlatSample& s) { return s.squares > 0; });
    bool clear = false;
    if (!c.flat.samples.empty()) c.used = choose_flat(c.flat.samples, clear);
    const auto found = std::ranges::count_if(c.used, [](char f) { return f != structured; });
    if (found < (side == sides.back() ? least_blocks : wanted_blocks)) continue;
    e.blocks = static_cast<int>(c.flat.samples.size());
    if (!clear)
      e.warnings.push_back(
          "no crowd of flat places stands out from the structure: the noise is likely to be "
          "overestimated. Give flat regions");
    return c;
  }
  const std::string size =
      fmt::format("{} x {} pixels", image.values.width(), image.values.height());
  if (any)
    throw InvalidInput("SEM noise",
                       fmt::format("no {} flat places of {} x {} pixels are found in {}",
                                   least_blocks, sides.back(), sides.back(), size),
                       "Give flat regions, or smaller blocks");
  throw InvalidInput("SEM noise",
                     e.black + e.white > 0
                         ? "hardly a place is free of saturated pixels and has noise"
                         : fmt::format("there is no noise in {}", size),
                     "Give an image as the microscope made it, with noise and not too small");
}

Chosen given_regions(const PlacedImage& image, const Mask& good, const SemNoiseOptions& o) {
  Chosen c{FlatSamples(image.values, good, o.degree), {}};
  for (std::size_t i = 0; i < o.regions.size(); ++i) {
    const PixelRectangle& r = o.regions[i];
    const std::string subject = fmt::format("region {}", i + 1);
    if (r.x0 < 0 || r.y0 < 0 || r.x1 > image.values.width() || r.y1 > image.values.height() ||
        r.x0 >= r.x1 || r.y0 >= r.y1)
      throw InvalidInput(
          subject,
          fmt::format(
              "columns {} to {} and rows {} to {} are not inside the image, which has {} x {}",
              r.x0, r.x1, r.y0, r.y1, image.values.width(), image.values.height()),
          "Give its lower-left corner and the upper-right one, which is not part of it");
    if (!c.flat.add(r))
      throw InvalidInput(subject,
                         fmt::format("{} pixels of it are valid and not saturated", count(good, r)),
                         fmt::format("Give a region of {} at least", 4 * c.flat.coefficients()));
    if (!(c.flat.samples.back().squares > 0))
      throw InvalidInput(subject, "there is no noise in it",
                         "Give a region that is not saturated or synthetic");
  }
  c.used.assign(c.flat.samples.size(), typical);
  return c;
}

/// The excess kurtosis: the mean of the fourth powers over the squared variance, minus 3, the value
/// for normal noise.
double kurtosis_of(const Chosen& c) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < c.used.size(); ++i) {
    const FlatSample& s = c.flat.samples[i];
    if (!c.used[i]) continue;
    const double n = static_cast<double>(s.pixels);
    // For normal residuals relative to their own variance, the mean is 3 (n - 1) / (n + 1).
    sum += n * (n * s.fourths / (s.squares * s.squares) * (n + 1) / (n - 1) - 3), weight += n;
  }
  return weight > 0 ? sum / weight : 0;
}

/// Fits the line, given the best known variance of each region, which the correlation needs.
void fit(const Chosen& c, const std::vector<double>& variances, const SemNoiseOptions& options,
         SemNoiseEstimate& e) {
  const LagSums correlation = pooled_correlation(c.flat, variances);
  set_correlation(correlation, e);
  e.excess_kurtosis = kurtosis_of(c);
  const double spread = std::max(2 * e.correlation_squares + e.excess_kurtosis, 0.2);
  std::vector<VariancePoint> points;
  e.points.clear();
  for (std::size_t i = 0; i < c.used.size(); ++i) {
    if (!c.used[i]) continue;
    const FlatSample& s = c.flat.samples[i];
    const double variance =
        variance_of(s, c.flat.responses[static_cast<std::size_t>(s.geometry)], correlation);
    points.push_back(
        {s.mean, variance, 2 * static_cast<double>(s.pixels - c.flat.coefficients()) / spread});
    e.points.push_back({s.region, s.pixels, s.mean, variance, 0, true});
  }
  set_line(points, options.least_share, options.regions.empty() ? cut : 0, e);
}

}  // namespace

SemNoiseEstimate estimate_sem_noise(const PlacedImage& image, const SemNoiseOptions& options) {
  validate(image, "SEM image");
  check_options(options);
  SemNoiseEstimate e;
  const Saturation saturated = find_saturation(image.values, image.valid, options, e);
  const Mask good = unsaturated(image, saturated);
  const Chosen c = options.regions.empty() ? find_flat(image, good, options, e)
                                           : given_regions(image, good, options);
  // Dividing a region by its own variance makes the correlation slightly too small, so the second
  // fit divides by the line's variance.
  std::vector<double> variances(c.used.size(), 0);
  for (std::size_t i = 0; i < variances.size(); ++i)
    if (c.used[i] == typical)
      variances[i] = c.flat.samples[i].squares / static_cast<double>(c.flat.samples[i].pixels);
  fit(c, variances, options, e);
  for (std::size_t i = 0, point = 0; i < variances.size(); ++i) {
    if (!c.used[i]) continue;
    variances[i] = e.points[point++].used && c.used[i] == typical
                       ? e.noise.variance(c.flat.samples[i].mean)
                       : 0;
  }
  fit(c, variances, options, e);
  set_off_line_share(image.values, good, e);
  add_warnings(e);
  return e;
}

}  // namespace surf
