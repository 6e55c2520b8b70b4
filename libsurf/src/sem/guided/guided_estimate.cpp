// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/guided_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "count_variance.h"
#include "gaussian_window.h"
#include "guided_tile.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

using namespace guided;

constexpr std::size_t most_guides = 15;
constexpr double yield_sigma_px = 3;       // of the yields that errors are relative to
constexpr double least_yield_share = 0.1;  // of the mean: darker pixels do not count for more
// Squared bias over spread, for each class of detail, where nothing more is known: as rough ground,
// a mesa, a trench and a sphere have it (docs/development/guided_images.md).
constexpr double usual_bias[detail_classes] = {0.33, 0.75, 1.4};
constexpr double unguided_bias = 0.5;  // where windows are all there is
constexpr double most_variance_scale = 4;
constexpr double detail_sigma_px = 1.5;
constexpr double detail_ranks[detail_classes] = {0.5, 0.85, 0.97};  // of the middle of each class
constexpr std::array<double, 2> peak_contrast{1.5, 2.5};  // of counts over those around: none, full
constexpr std::array<double, 2> peak_deviations{4, 6};    // and by how many of their deviations
constexpr double risk_sigma_px = 5;                       // of the pixels whose risk is averaged
// A pixel that differs from its estimate by more than this many standard deviations of its counts
// keeps what is beyond (Efron and Morris 1972, doi:10.1080/01621459.1972.10481215).
constexpr double most_deviations = 4;
// Few counts scatter upward more than so: what has a variance of slope * mean exceeds its mean by
// this many slopes more (Cornish and Fisher 1938, doi:10.2307/1400905: (z^2 - 1) / 6 of the third
// cumulant over the second).
constexpr double skewness_share = (most_deviations * most_deviations - 1) / 6;

void check(const CountImage& counts, const std::vector<Guide>& guides, const Grid<int>& region) {
  const int width = counts[0].primaries.width(), height = counts[0].primaries.height();
  const auto check_plane = [&](const Grid<double>& plane, const std::string& subject,
                               double least) {
    if (plane.width() != width || plane.height() != height || plane.empty())
      throw InvalidInput(subject,
                         fmt::format("it has {} x {} pixels, the counts {} x {}", plane.width(),
                                     plane.height(), width, height),
                         "Give all of one size");
    for (const double value : plane.data())
      if (!(std::isfinite(value) && value >= least))
        throw InvalidInput(subject, fmt::format("a pixel is {}", value),
                           "Give numbers that are finite and in range");
  };
  constexpr double any = -std::numeric_limits<double>::max();
  for (const CountHalf& half : counts) {
    check_plane(half.primaries, "numbers of primaries", 0);
    check_plane(half.sum, "counts", any);
    check_plane(half.squares, "squares of counts", 0);
  }
  if (guides.size() > most_guides)
    throw InvalidInput("guides", fmt::format("there are {}", guides.size()), "Give 15 or fewer");
  for (const Guide& guide : guides) {
    check_plane(guide.values, "guide " + guide.name, any);
    if (!guide.of_first.empty()) check_plane(guide.of_first, "guide " + guide.name, any);
  }
  if (!region.empty() && (region.width() != width || region.height() != height))
    throw InvalidInput("regions", "they have another size than the counts", "Give all of one size");
}

std::set<int> numbers_of(const Grid<int>& region) {
  std::set<int> numbers;
  for (const int number : region.data())
    if (number >= 0) numbers.insert(number);
  if (region.empty()) numbers.insert(0);
  return numbers;
}

/// A guide's values over the pixels of a region, on the scale that has mean 0 and variance 1 in
/// `first`. Empty: they do not vary.
std::vector<double> standardized(const RegionCounts& counts, const Grid<double>& values,
                                 const Grid<double>& first) {
  double n = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < counts.seen.size(); ++i)
    if (counts.counts(i)) n += 1, sum += first.data()[i];
  const double mean = sum / n;
  for (std::size_t i = 0; i < counts.seen.size(); ++i)
    if (counts.counts(i)) squares += std::pow(first.data()[i] - mean, 2);
  const double deviation = std::sqrt(squares / n);
  if (!(deviation > 1e-9 * std::abs(mean)) || !std::isfinite(deviation)) return {};
  std::vector<double> out(counts.seen.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (counts.counts(i)) out[i] = (values.data()[i] - mean) / deviation;
  return out;
}

/// Guides that vary, of those that are made of counts or of the others.
void add_guides(const std::vector<Guide>& guides, bool of_counts, GuidedRegion& r) {
  for (const Guide& guide : guides) {
    if (guide.of_first.empty() == of_counts) continue;
    std::vector<double> values = standardized(r.counts, guide.values, guide.values);
    if (values.empty()) continue;
    if (guide.predicts) r.predicting.push_back(static_cast<int>(r.guides[0].size()));
    r.guides[1].push_back(
        guide.of_first.empty() ? values : standardized(r.counts, guide.of_first, guide.values));
    r.guides[0].push_back(std::move(values));
  }
}

double ramp(double value, const std::array<double, 2>& from_to) {
  return std::clamp((value - from_to[0]) / (from_to[1] - from_to[0]), 0.0, 1.0);
}

/// How sharply the guides bend at each pixel, by its rank among the region's pixels.
void set_detail(GuidedRegion& r) {
  const GaussianWindow window(detail_sigma_px);
  std::vector<double> bend(r.counts.seen.size(), 0.0), seen = bend, scratch;
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = r.counts.counts(i) ? 1 : 0;
  window.sum(seen, r.counts.width, r.counts.height, scratch);
  for (const std::vector<double>& guide : r.guides[0]) {
    std::vector<double> smooth = guide;
    window.sum(smooth, r.counts.width, r.counts.height, scratch);
    for (std::size_t i = 0; i < bend.size(); ++i)
      if (r.counts.counts(i)) bend[i] += std::pow(guide[i] - smooth[i] / seen[i], 2);
  }
  std::vector<double> sorted;
  for (std::size_t i = 0; i < bend.size(); ++i)
    if (r.counts.counts(i)) sorted.push_back(bend[i]);
  std::ranges::sort(sorted);
  r.detail.assign(bend.size(), 0.0);
  for (std::size_t i = 0; i < bend.size(); ++i) {
    if (!r.counts.counts(i)) continue;
    const auto below = std::ranges::lower_bound(sorted, bend[i]) - sorted.begin();
    const double rank = static_cast<double>(below) / static_cast<double>(sorted.size());
    int c = 0;
    while (c + 2 < detail_classes && rank > detail_ranks[c + 1]) ++c;
    r.detail[i] = std::clamp(c + (rank - detail_ranks[c]) / (detail_ranks[c + 1] - detail_ranks[c]),
                             0.0, detail_classes - 1.0);
  }
}

/// Counts that stand out of those around in full are as sharp a detail as there is, whatever the
/// guides say: windows that suit the many dark pixels around would level the few bright ones, which
/// hold what is counted. By chance alone none stands out so far.
void add_detail_of_counts(const std::vector<double>& pilot, GuidedRegion& r) {
  const GaussianWindow wide(risk_sigma_px);
  const double pilot_pixels = 4 * std::numbers::pi * pilot_sigma_px * pilot_sigma_px;
  std::vector<double> around(pilot.size(), 0.0), seen = around, scratch;
  for (std::size_t i = 0; i < around.size(); ++i)
    if (r.counts.counts(i)) around[i] = r.counts.mean(i), seen[i] = 1;
  wide.sum(around, r.counts.width, r.counts.height, scratch);
  wide.sum(seen, r.counts.width, r.counts.height, scratch);
  for (std::size_t i = 0; i < pilot.size(); ++i) {
    if (!r.counts.counts(i)) continue;
    const double level = around[i] / seen[i],
                 noise = r.variance.of_mean(level, pilot_pixels * r.counts.primaries(i));
    const double share = std::min(ramp(pilot[i] / std::max(level, r.variance.least), peak_contrast),
                                  ramp((pilot[i] - level) / std::sqrt(noise), peak_deviations));
    r.detail[i] = std::max(r.detail[i], (detail_classes - 1.0) * share);
  }
}

/// Weights of squared errors: errors count relative to the yield around.
void set_weights(GuidedRegion& r) {
  const GaussianWindow window(yield_sigma_px);
  std::vector<double> yields(r.counts.seen.size(), 0.0), seen = yields, scratch;
  double n = 0, sum = 0;
  for (std::size_t i = 0; i < yields.size(); ++i)
    if (r.counts.counts(i)) yields[i] = r.counts.mean(i), seen[i] = 1, n += 1, sum += yields[i];
  const double least = least_yield_share * std::max(sum / n, r.variance.least);
  window.sum(yields, r.counts.width, r.counts.height, scratch);
  window.sum(seen, r.counts.width, r.counts.height, scratch);
  r.weight.assign(yields.size(), 0.0);
  for (std::size_t i = 0; i < yields.size(); ++i)
    if (r.counts.counts(i)) r.weight[i] = 1 / std::pow(std::max(yields[i] / seen[i], least), 2);
}

/// What both halves say of a pixel's squared error.
struct PixelErrors {
  double value = 0;
  double variance = 0;    ///< of `value`, by the windows' weights
  double difference = 0;  ///< the same, by the difference of the halves: right on average
  double risk = 0;        ///< Stein's estimate of a half's squared error, less its variance: its
                          ///< squared bias, right on average
  double half_noise = 0;  ///< variance of a half's plain mean
};

PixelErrors errors_of(const GuidedRegion& r, const GuidedPlanes& planes, std::size_t i) {
  PixelErrors e;
  const double n = r.counts.primaries(i);
  double share = 1;
  for (std::size_t h = 0; h < 2; ++h) {
    const HalfPlanes& half = planes.halves[h];
    const double part = r.counts.halves[h].primaries[i] / n;
    const double residual = half.value[i] - r.counts.halves[h].mean[i];
    e.value += part * half.value[i];
    e.variance += part * part * half.variance[i];
    e.risk += 0.5 * (residual * residual + (2 * half.leverage[i] - 1) * r.raw_noise[h][i]);
    e.half_noise += 0.5 * r.noise[h][i];
    share *= part;
  }
  const double apart = planes.halves[0].value[i] - planes.halves[1].value[i];
  e.difference = apart * apart * share;
  return e;
}

/// The region's squared errors: variance and bias.
struct ErrorModel {
  std::array<double, detail_classes> variance{};  ///< over that by the windows' weights
  std::array<double, detail_classes> bias{};      ///< squared, over the spread

  std::array<double, detail_classes> level{1, 1, 1};  ///< of both, by Stein's risk of the class

  double variance_scale(double detail) const { return of(variance, detail); }
  /// The squared error of a pixel's estimate from this variance by the windows' weights: never
  /// below its variance, which the halves tell well.
  double expected(double variance_by_weights, double spread, double detail) const {
    const double noise = of(variance, detail) * variance_by_weights;
    return std::max(of(level, detail) * (noise + of(bias, detail) * spread), noise);
  }

 private:
  static double of(const std::array<double, detail_classes>& scales, double detail) {
    double scale = 0;
    for (int c = 0; c < detail_classes; ++c) scale += share_of_class(c, detail) * scales[c];
    return scale;
  }
};

/// What squared errors are in truth over what is expected of them, before anything is seen: most
/// are right within a factor, and some are off by far. The mean is 1.
struct RatioPrior {
  static constexpr std::size_t steps = 48;
  std::array<double, steps> value, weight;

  RatioPrior() {
    constexpr double lowest = -2.4, step = 0.2;                           // of logarithms
    constexpr double usual = 0.5, unusual = 1.5, share_of_unusual = 0.1;  // their deviations
    double sum = 0, mean = 0;
    for (std::size_t k = 0; k < steps; ++k) {
      const double x = lowest + static_cast<double>(k) * step;
      value[k] = std::exp(x);
      weight[k] = (1 - share_of_unusual) / usual * std::exp(-0.5 * x * x / (usual * usual)) +
                  share_of_unusual / unusual * std::exp(-0.5 * x * x / (unusual * unusual));
      sum += weight[k], mean += weight[k] * value[k];
    }
    for (double& v : value) v *= sum / mean;
  }
};

/// The mean a posteriori of such a ratio that is seen as `ratio` with a variance of `doubt`: what
/// chance alone may show hardly counts, and what it cannot show counts in full.
double likely_ratio(double ratio, double doubt) {
  static const RatioPrior prior;
  if (!(doubt > 0)) return std::max(ratio, prior.value.front());
  double nearest = std::numeric_limits<double>::max(), sum = 0, mean = 0;
  for (const double v : prior.value) nearest = std::min(nearest, (v - ratio) * (v - ratio));
  for (std::size_t k = 0; k < RatioPrior::steps; ++k) {
    const double away = prior.value[k] - ratio,
                 w = prior.weight[k] * std::exp(-0.5 * (away * away - nearest) / doubt);
    sum += w, mean += w * prior.value[k];
  }
  return mean / sum;
}

/// What Stein's risk says of a class as a whole, over what is expected of it.
double level_of(const GuidedRegion& r, const GuidedPlanes& planes, const ErrorModel& model,
                int detail_class) {
  double seen = 0, expected = 0, doubt = 0, noise = 0;
  for (std::size_t i = 0; i < r.counts.seen.size(); ++i) {
    if (!r.counts.counts(i)) continue;
    const double w = share_of_class(detail_class, r.detail[i]) * r.weight[i];
    if (w == 0) continue;
    const PixelErrors e = errors_of(r, planes, i);
    seen += w * (e.risk - model.variance_scale(r.detail[i]) * e.variance);
    expected += w * model.expected(e.variance, planes.spread[i], r.detail[i]);
    doubt += std::pow(w * e.half_noise, 2);
    noise += w * e.half_noise;
  }
  doubt += r.variance.noise_scale_doubt * noise * noise;
  if (!(expected > 0)) return 1;
  return likely_ratio(seen / expected, doubt / (expected * expected));
}

ErrorModel fit_errors(const GuidedRegion& r, const GuidedPlanes& planes) {
  ErrorModel model;
  std::array<double, detail_classes> by_difference{}, by_weights{};
  const std::size_t pixels = r.counts.seen.size();
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!r.counts.counts(i)) continue;
    const PixelErrors e = errors_of(r, planes, i);
    for (int c = 0; c < detail_classes; ++c) {
      const double w = share_of_class(c, r.detail[i]) * r.weight[i];
      by_difference[c] += w * e.difference;
      by_weights[c] += w * e.variance;
    }
  }
  for (int c = 0; c < detail_classes; ++c)
    model.variance[c] = by_weights[c] > 0 ? std::clamp(by_difference[c] / by_weights[c],
                                                       1 / most_variance_scale, most_variance_scale)
                                          : 1;
  for (int c = 0; c < detail_classes; ++c)
    model.bias[c] = r.guides[0].empty() ? unguided_bias : usual_bias[c];
  std::array<double, detail_classes> level;
  for (int c = 0; c < detail_classes; ++c) level[c] = level_of(r, planes, model, c);
  model.level = level;
  return model;
}

/// What is seen of squared errors around each pixel, relative to yields squared.
struct ErrorsAround {
  std::vector<double> ratio;  ///< seen over expected
  std::vector<double> doubt;  ///< variance of `ratio`, by the noise of the counts
};

ErrorsAround errors_around(const GuidedRegion& r, const GuidedPlanes& planes,
                           const ErrorModel& model) {
  const GaussianWindow window(risk_sigma_px);
  const std::size_t pixels = r.counts.seen.size();
  std::vector<double> seen(pixels, 0.0), expected = seen, doubt = seen, noise = seen, scratch;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!r.counts.counts(i)) continue;
    const PixelErrors e = errors_of(r, planes, i);
    const double variance = model.variance_scale(r.detail[i]) * e.variance;
    seen[i] = r.weight[i] * (e.risk - variance);
    expected[i] = r.weight[i] * model.expected(e.variance, planes.spread[i], r.detail[i]);
    noise[i] = r.weight[i] * e.half_noise;
    doubt[i] = noise[i] * noise[i];
  }
  window.sum(noise, r.counts.width, r.counts.height, scratch);
  window.sum(seen, r.counts.width, r.counts.height, scratch);
  window.sum(expected, r.counts.width, r.counts.height, scratch);
  // Weights squared are a window narrower by the root of two.
  const GaussianWindow squared(risk_sigma_px / std::numbers::sqrt2);
  squared.sum(doubt, r.counts.width, r.counts.height, scratch);
  const double narrower = window.middle() * window.middle() / squared.middle();
  ErrorsAround around{std::vector<double>(pixels, 1.0), std::vector<double>(pixels, 0.0)};
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!(expected[i] > 0)) continue;
    around.ratio[i] = seen[i] / expected[i];
    around.doubt[i] = (narrower * doubt[i] + r.variance.noise_scale_doubt * noise[i] * noise[i]) /
                      (expected[i] * expected[i]);
  }
  return around;
}

void put(const GuidedRegion& r, const GuidedPlanes& planes, double library_cascades,
         GuidedImage& out) {
  const ErrorModel model = fit_errors(r, planes);
  const ErrorsAround around = errors_around(r, planes, model);
  for (std::size_t i = 0; i < around.ratio.size(); ++i) {
    if (!r.counts.counts(i)) continue;
    const PixelErrors e = errors_of(r, planes, i);
    double value = e.value;
    const double noise = r.variance.of_mean(value, r.counts.primaries(i)),
                 variance = model.variance_scale(r.detail[i]) * e.variance;
    double square = model.expected(e.variance, planes.spread[i], r.detail[i]) *
                    likely_ratio(around.ratio[i], around.doubt[i]);
    const double away = r.counts.mean(i) - value,
                 beyond =
                     std::abs(away) - most_deviations * std::sqrt(noise) -
                     (away > 0 ? skewness_share * r.variance.slope / r.counts.primaries(i) : 0);
    if (beyond > 0) {
      value += std::copysign(beyond, away);
      // What is kept of a pixel's own counts has their noise.
      square = std::min(
          square + beyond * beyond,
          std::max(square, r.variance.of_mean(std::max(value, e.value), r.counts.primaries(i))));
    }
    if (variance > 0)
      out.radius_px.data()[i] = std::sqrt(std::max(1.0, noise / variance) * std::numbers::inv_pi);
    if (library_cascades > 0) square += r.variance.of_one(value) / library_cascades;
    out.mean.data()[i] = value;
    for (std::size_t h = 0; h < 2; ++h) out.halves[h].data()[i] = planes.halves[h].value[i];
    out.error.data()[i] = std::sqrt(square);
  }
}

}  // namespace

Grid<double> mean_around(const Grid<double>& values, const Grid<double>& weights, double sigma_px) {
  const GaussianWindow window(sigma_px);
  std::vector<double> sums(values.size()), seen = weights.data(), scratch;
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = values.data()[i] * seen[i];
  window.sum(sums, values.width(), values.height(), scratch);
  window.sum(seen, values.width(), values.height(), scratch);
  Grid<double> mean(values.width(), values.height(), 0.0);
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (seen[i] > 0) mean.data()[i] = sums[i] / seen[i];
  return mean;
}

GuidedImage estimate_guided(const CountImage& counts, const std::vector<Guide>& guides,
                            const GuidedOptions& options) {
  check(counts, guides, options.region);
  const int width = counts[0].primaries.width(), height = counts[0].primaries.height();
  GuidedImage out;
  for (auto* plane : {&out.mean, &out.error, &out.radius_px, &out.halves[0], &out.halves[1]})
    *plane = Grid<double>(width, height, 0.0);
  std::vector<PixelRange> tiles;
  for (int y = 0; y < height; y += tile_px)
    for (int x = 0; x < width; x += tile_px)
      tiles.push_back({x, y, std::min(x + tile_px, width), std::min(y + tile_px, height)});
  const std::set<int> numbers = numbers_of(options.region);
  double pixels = 0, scales = 0, done = 0;
  const double all = static_cast<double>(numbers.size() * tiles.size());
  for (const int number : numbers) {
    GuidedRegion r;
    r.counts = region_counts(counts, options.region, number);
    const std::vector<double> pilot = pilot_means(r.counts);
    r.variance = fit_count_variance(r.counts, pilot, options.library_cascades);
    double here = 0;
    for (std::size_t h = 0; h < 2; ++h) {
      r.noise[h].assign(pilot.size(), 0.0);
      r.raw_noise[h].assign(pilot.size(), 0.0);
      const HalfCounts& half = r.counts.halves[h];
      for (std::size_t i = 0; i < pilot.size(); ++i) {
        if (!r.counts.counts(i)) continue;
        here += 0.5;
        const double n = half.primaries[i];
        r.noise[h][i] = r.variance.of_mean(pilot[i], n);
        r.raw_noise[h][i] =
            half.scatter[i] >= 0 ? r.variance.noise_scale * half.scatter[i] / n : r.noise[h][i];
      }
    }
    if (here == 0) continue;
    add_guides(guides, false, r);
    set_weights(r);
    set_detail(r);  // by guides without noise
    add_detail_of_counts(pilot, r);
    add_guides(guides, true, r);
    GuidedPlanes planes;
    planes.spread.assign(pilot.size(), 0.0);
    for (HalfPlanes& half : planes.halves)
      for (auto* plane : {&half.value, &half.variance, &half.leverage})
        plane->assign(pilot.size(), 0.0);
    for (const PixelRange& tile : tiles) {
      options.watch.report(done++, all);
      estimate_tile(r, tile, options.threads, planes);
    }
    put(r, planes, options.library_cascades, out);
    pixels += here;
    scales += here * r.variance.noise_scale;
  }
  options.watch.report(all, all);
  if (pixels > 0) out.noise_scale = scales / pixels;
  return out;
}

}  // namespace surf
