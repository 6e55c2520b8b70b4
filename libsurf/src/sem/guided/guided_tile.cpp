// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided_tile.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex_weights.h"
#include "gaussian_window.h"
#include "surf/core/parallel.h"

namespace surf::guided {
namespace {

// Standard deviations of windows, in pixels. Narrow windows hold too few pixels for slopes.
constexpr double plain_scales[] = {1, 2, 4}, guided_scales[] = {2, 4, 8, 16};
// The risk of combinations is summed over squares of pixels, and these in a window.
constexpr int square_px = 4;
constexpr double risk_sigma_px = 10;
constexpr double spread_sigma_px = 3;

int radius_of(double sigma_px) { return GaussianWindow(sigma_px).radius(); }

PixelRange grown(const PixelRange& r, int by, int width, int height) {
  return {std::max(0, r.x0 - by), std::max(0, r.y0 - by), std::min(width, r.x1 + by),
          std::min(height, r.y1 + by)};
}

PixelRange within(const PixelRange& r, const PixelRange& of) {
  return {r.x0 - of.x0, r.y0 - of.y0, r.x1 - of.x0, r.y1 - of.y0};
}

std::vector<double> cut(const std::vector<double>& plane, int width, const PixelRange& r) {
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(r.width()) * static_cast<std::size_t>(r.height()));
  for (int y = r.y0; y < r.y1; ++y) {
    const auto row = plane.begin() + static_cast<std::ptrdiff_t>(y) * width;
    out.insert(out.end(), row + r.x0, row + r.x1);
  }
  return out;
}

/// Estimates of the pixels of a range, the plain counts first.
struct Candidates {
  PixelRange range;
  std::vector<LocalFit> fits;  ///< over `range`
};

Candidates candidates_of(const GuidedRegion& region, std::size_t half, const PixelRange& range,
                         int threads) {
  const std::vector<double>& mean = region.counts.halves[half].mean;
  const std::vector<double>& noise = region.noise[half];
  const std::vector<std::vector<double>>& guides = region.guides[half];
  const int width = region.counts.width, height = region.counts.height;
  Candidates out{range, {}};
  LocalFit plain{cut(mean, width, range), cut(noise, width, range), {}};
  plain.leverage.assign(plain.value.size(), 1.0);
  out.fits.push_back(std::move(plain));
  const auto add = [&](double sigma_px, bool with_guides,
                       const std::vector<std::vector<int>>& sets) {
    const PixelRange outer = grown(range, radius_of(sigma_px), width, height);
    LocalData data{
        outer.width(), outer.height(), cut(mean, width, outer), cut(noise, width, outer), {}};
    for (double& p : data.precision) p = p > 0 ? 1 / p : 0;
    if (with_guides)
      for (const std::vector<double>& guide : guides)
        data.guides.push_back(cut(guide, width, outer));
    const PixelRange wanted = within(range, outer);
    for (LocalFit& fit : fit_locally(data, sigma_px, wanted, sets, threads))
      out.fits.push_back({cut(fit.value, outer.width(), wanted),
                          cut(fit.variance, outer.width(), wanted),
                          cut(fit.leverage, outer.width(), wanted)});
  };
  for (const double sigma : plain_scales) add(sigma, false, {{}});
  std::vector<std::vector<int>> sets;
  if (!region.predicting.empty() && region.predicting.size() < guides.size())
    sets.push_back(region.predicting);
  std::vector<int> all(guides.size());
  std::iota(all.begin(), all.end(), 0);
  sets.push_back(std::move(all));  // without guides: means over wider windows
  for (const double sigma : guided_scales)
    if (!guides.empty() || sigma > plain_scales[2]) add(sigma, true, sets);
  return out;
}

/// Weights of the candidates in the squares of a range, for one class of detail.
class SquareWeights {
 public:
  SquareWeights(const GuidedRegion& region, std::size_t half, const Candidates& candidates,
                const PixelRange& needed, int detail_class, int threads)
      : range_(candidates.range), first_x_(candidates.range.x0 / square_px),
        first_y_(candidates.range.y0 / square_px),
        columns_((range_.x1 + square_px - 1) / square_px - first_x_),
        rows_((range_.y1 + square_px - 1) / square_px - first_y_), count_(candidates.fits.size()) {
    const std::size_t pairs = count_ * (count_ + 1) / 2;
    std::vector<std::vector<double>> sums(pairs + count_);
    std::vector<double> weight = cut(region.weight, region.counts.width, range_);
    const std::vector<double> detail = cut(region.detail, region.counts.width, range_),
                              noise = cut(region.raw_noise[half], region.counts.width, range_);
    for (std::size_t i = 0; i < weight.size(); ++i)
      weight[i] *= share_of_class(detail_class, detail[i]);
    const std::vector<double>& plain = candidates.fits[0].value;
    std::vector<std::vector<double>> scratch(static_cast<std::size_t>(resolve_threads(threads)));
    const GaussianWindow window(risk_sigma_px / square_px);
    parallel_for(sums.size(), threads, [&](std::size_t unit, int worker) {
      std::vector<double>& sum = sums[unit];
      sum.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0.0);
      std::size_t a = 0;
      while (unit < pairs && (a + 1) * (a + 2) / 2 <= unit) ++a;
      std::size_t i = 0;
      for (int y = range_.y0; y < range_.y1; ++y) {
        double* const row = sum.data() + (y / square_px - first_y_) * columns_;
        for (int x = range_.x0; x < range_.x1; ++x, ++i) {
          if (weight[i] == 0) continue;
          double& to = row[x / square_px - first_x_];
          if (unit >= pairs) {
            to += weight[i] * noise[i] * candidates.fits[unit - pairs].leverage[i];
            continue;
          }
          const LocalFit &one = candidates.fits[a],
                         &other = candidates.fits[unit - a * (a + 1) / 2];
          to += weight[i] * (one.value[i] - plain[i]) * (other.value[i] - plain[i]);
        }
      }
      window.sum(sum, columns_, rows_, scratch[static_cast<std::size_t>(worker)]);
    });
    weights_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) * count_,
                    0.0);
    const int low = std::max(0, needed.y0 / square_px - 1 - first_y_),
              high = std::min(rows_, needed.y1 / square_px + 2 - first_y_);
    parallel_for(static_cast<std::size_t>(high - low), threads, [&](std::size_t unit, int) {
      std::vector<double> matrix(count_ * count_), linear(count_);
      for (int x = 0; x < columns_; ++x) {
        const std::size_t at =
            (static_cast<std::size_t>(low) + unit) * static_cast<std::size_t>(columns_) +
            static_cast<std::size_t>(x);
        for (std::size_t a = 0; a < count_; ++a) {
          linear[a] = sums[pairs + a][at];
          for (std::size_t b = 0; b <= a; ++b)
            matrix[a * count_ + b] = matrix[b * count_ + a] = sums[a * (a + 1) / 2 + b][at];
        }
        std::ranges::copy(convex_weights(matrix, linear),
                          weights_.begin() + static_cast<std::ptrdiff_t>(at * count_));
      }
    });
  }

  /// Adds a share of the weights at a pixel: between the middles of squares, linearly.
  void add_at(int x, int y, double share_of_class, std::vector<double>& out) const {
    const auto [x0, x1, tx] = between(x, first_x_, columns_);
    const auto [y0, y1, ty] = between(y, first_y_, rows_);
    const auto add = [&](int column, int row, double share) {
      const double* const from =
          weights_.data() +
          (static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)) * count_;
      for (std::size_t k = 0; k < count_; ++k) out[k] += share * from[k];
    };
    add(x0, y0, share_of_class * (1 - tx) * (1 - ty));
    add(x1, y0, share_of_class * tx * (1 - ty));
    add(x0, y1, share_of_class * (1 - tx) * ty);
    add(x1, y1, share_of_class * tx * ty);
  }

 private:
  struct Between {
    int before, after;
    double share;  // of the one after
  };
  static Between between(int pixel, int first, int count) {
    const double place = (pixel + 0.5) / square_px - 0.5 - first;
    const int before = std::clamp(static_cast<int>(std::floor(place)), 0, count - 1),
              after = std::min(before + 1, count - 1);
    return {before, after, std::clamp(place - before, 0.0, 1.0)};
  }

  PixelRange range_;
  int first_x_, first_y_, columns_, rows_;
  std::size_t count_;
  std::vector<double> weights_;  // [square][candidate]
};

}  // namespace

void estimate_tile(const GuidedRegion& region, const PixelRange& tile, int threads,
                   GuidedPlanes& out) {
  const int width = region.counts.width, height = region.counts.height;
  // The spread is averaged over some pixels, whose weights need the risk around them.
  const PixelRange combined = grown(tile, radius_of(spread_sigma_px), width, height);
  const int around = square_px * (radius_of(risk_sigma_px / square_px) + 2);
  const PixelRange range = grown(combined, around, width, height);
  std::array<Candidates, 2> candidates;
  std::array<std::vector<SquareWeights>, 2> chosen;
  for (std::size_t h = 0; h < 2; ++h) {
    candidates[h] = candidates_of(region, h, range, threads);
    for (int c = 0; c < detail_classes; ++c)
      chosen[h].emplace_back(region, h, candidates[h], combined, c, threads);
  }
  std::vector<double> spread(static_cast<std::size_t>(combined.width()) *
                             static_cast<std::size_t>(combined.height())),
      seen(spread.size()), weights, scratch;
  std::size_t at = 0;
  for (int y = combined.y0; y < combined.y1; ++y)
    for (int x = combined.x0; x < combined.x1; ++x, ++at) {
      const std::size_t image = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x);
      if (!region.counts.counts(image)) continue;
      const std::size_t i =
          static_cast<std::size_t>(y - range.y0) * static_cast<std::size_t>(range.width()) +
          static_cast<std::size_t>(x - range.x0);
      seen[at] = 1;
      for (std::size_t h = 0; h < 2; ++h) {
        weights.assign(candidates[h].fits.size(), 0.0);
        for (int c = 0; c < detail_classes; ++c)
          if (const double share = share_of_class(c, region.detail[image]); share > 0)
            chosen[1 - h][static_cast<std::size_t>(c)].add_at(x, y, share, weights);
        double value = 0, deviation = 0, leverage = 0, square = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
          const LocalFit& fit = candidates[h].fits[k];
          value += weights[k] * fit.value[i];
          deviation += weights[k] * std::sqrt(fit.variance[i]);
          leverage += weights[k] * fit.leverage[i];
        }
        for (std::size_t k = 1; k < weights.size(); ++k)
          square += weights[k] * std::pow(candidates[h].fits[k].value[i] - value, 2);
        spread[at] += 0.5 * square;
        if (x < tile.x0 || x >= tile.x1 || y < tile.y0 || y >= tile.y1) continue;
        out.halves[h].value[image] = value;
        out.halves[h].variance[image] = deviation * deviation;
        out.halves[h].leverage[image] = leverage;
      }
    }
  const GaussianWindow window(spread_sigma_px);
  window.sum(spread, combined.width(), combined.height(), scratch);
  window.sum(seen, combined.width(), combined.height(), scratch);
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) {
      const std::size_t image = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x);
      const std::size_t i =
          static_cast<std::size_t>(y - combined.y0) * static_cast<std::size_t>(combined.width()) +
          static_cast<std::size_t>(x - combined.x0);
      if (region.counts.counts(image)) out.spread[image] = spread[i] / seen[i];
    }
}

}  // namespace surf::guided
