// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/noise_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "afm/samples.h"
#include "surf/afm/background.h"

namespace surf {
namespace {

constexpr std::size_t least_samples = 16;
constexpr double highest_alpha = 0.999;

struct Covariances {
  double r0 = 0, r1 = 0;
  std::size_t samples = 0, pairs = 0;
};

Covariances covariances(const HeightField& residual, const Mask& use) {
  Covariances c;
  for (int y = 0; y < residual.z_nm.height(); ++y) {
    for (int x = 0; x < residual.z_nm.width(); ++x) {
      if (!is_used(residual, use, x, y)) continue;
      const double e = residual.z_nm(x, y);
      c.r0 += e * e;
      ++c.samples;
      if (x == 0 || !is_used(residual, use, x - 1, y)) continue;
      c.r1 += e * residual.z_nm(x - 1, y);
      ++c.pairs;
    }
  }
  c.r0 /= static_cast<double>(std::max<std::size_t>(c.samples, 1));
  c.r1 /= static_cast<double>(std::max<std::size_t>(c.pairs, 1));
  return c;
}

/// A least-squares polynomial removes the noise's power at frequency 0, r(0) (1 + a) / (1 - a),
/// once for each of its coefficients (Brockwell and Davis 1991, 7.1). This lowers both covariances
/// by the same amount.
double removed_power(double r0, double r1, int terms, std::size_t samples) {
  double lost = 0;
  const double share = terms / static_cast<double>(samples);
  for (int i = 0; i < 50; ++i) {
    const double a = std::clamp((r1 + lost) / (r0 + lost), -highest_alpha, 0.99);
    lost = std::min(share * (r0 + lost) * (1 + a) / (1 - a), r0);
  }
  return lost;
}

NoiseEstimate with_errors(double r0, double alpha, std::size_t samples) {
  NoiseEstimate e;
  const double n = static_cast<double>(samples);
  e.noise = {alpha, (1 - alpha * alpha) * r0};
  e.samples = samples;
  e.alpha_stderr = std::sqrt((1 - alpha * alpha) / n);
  e.innovation_stderr_nm2 = e.noise.innovation_nm2 * std::sqrt(2 / n);
  e.sigma_stderr_nm = std::sqrt(r0 * (1 + alpha * alpha) / (1 - alpha * alpha) / (2 * n));
  return e;
}

// For images with structure.

constexpr std::size_t most_distances = 4;  // k = 1 ... 4
constexpr int most_bands = 8;
constexpr double clip = 4;  // standard deviations
// The variance of a normal number within +-4 standard deviations.
constexpr double clipped_variance = 0.99893;
constexpr double median_of_normal = 0.67448975019608171;
constexpr double alpha_limit = 0.9;
constexpr std::size_t enough_centres = 1'000'000;

using Differences = std::array<double, most_distances>;  // D_k about one sample

struct Centres {
  std::size_t distances = 0;
  std::vector<std::vector<Differences>> bands;  // bands of rows
};

/// Returns false if a hole is too near.
bool difference(const HeightField& f, int x, int y, std::size_t distances, Differences& d) {
  constexpr double weight[] = {1, -2, 1};
  d = {};
  for (int j = 0; j < 3; ++j) {
    const int row = y + j - 1;
    for (int k = 1; k <= static_cast<int>(distances); ++k) {
      if (!(f.is_valid(x - k, row) && f.is_valid(x, row) && f.is_valid(x + k, row))) return false;
      d[static_cast<std::size_t>(k - 1)] +=
          weight[j] * (f.z_nm(x - k, row) - 2 * f.z_nm(x, row) + f.z_nm(x + k, row));
    }
  }
  return true;
}

/// Skips rows if there are more centres than needed.
Centres mixed_differences(const HeightField& field) {
  const int width = field.z_nm.width(), height = field.z_nm.height();
  Centres out;
  out.distances = std::min(most_distances, static_cast<std::size_t>((width - 1) / 2));
  if (out.distances < 2 || height < 3) return out;
  out.bands.resize(static_cast<std::size_t>(std::clamp((height - 2) / 2, 1, most_bands)));
  const int every = 1 + static_cast<int>(field.z_nm.size() / enough_centres);
  const int margin = static_cast<int>(out.distances);
  for (int y = 1; y + 1 < height; y += every) {
    auto& band = out.bands[static_cast<std::size_t>(y - 1) * out.bands.size() /
                           static_cast<std::size_t>(height - 2)];
    Differences d;
    for (int x = margin; x + margin < width; ++x)
      if (difference(field, x, y, out.distances, d)) band.push_back(d);
  }
  return out;
}

double variance_from_median(const Centres& centres, std::size_t k) {
  std::vector<double> all;
  for (const auto& band : centres.bands)
    for (const Differences& d : band) all.push_back(std::fabs(d[k]));
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle * *middle / (median_of_normal * median_of_normal);
}

/// Sums over the values of a band that are not clipped.
struct BandSum {
  Differences squares{};
  std::size_t count = 0;
};

Differences variances(const std::vector<BandSum>& sums, std::size_t without) {
  Differences v{};
  double count = 0;
  for (std::size_t b = 0; b < sums.size(); ++b) {
    if (b == without) continue;
    count += static_cast<double>(sums[b].count);
    for (std::size_t k = 0; k < v.size(); ++k) v[k] += sums[b].squares[k];
  }
  for (double& each : v) each /= std::max(count, 1.0) * clipped_variance;
  return v;
}

std::vector<BandSum> clipped_sums(const Centres& centres, const Differences& variance) {
  std::vector<BandSum> sums(centres.bands.size());
  for (std::size_t b = 0; b < sums.size(); ++b) {
    for (const Differences& d : centres.bands[b]) {
      bool calm = true;
      for (std::size_t k = 0; k < centres.distances; ++k)
        calm &= d[k] * d[k] <= clip * clip * variance[k];
      if (!calm) continue;
      ++sums[b].count;
      for (std::size_t k = 0; k < centres.distances; ++k) sums[b].squares[k] += d[k] * d[k];
    }
  }
  return sums;
}

/// var D_k / s^2 of an AR(1) process whose rows are independent.
double expected_variance(double alpha, std::size_t k) {
  const double a = std::pow(alpha, static_cast<double>(k));
  return 12 * (1 - a) * (3 - a);
}

/// Least-squares fit of the logarithms: first on a lattice of alpha, then between its neighbours.
AfmNoise fit_model(const Differences& variance, std::size_t distances) {
  double log_s2 = 0;
  const auto misfit = [&](double alpha) {
    double sum = 0, squares = 0;
    for (std::size_t k = 0; k < distances; ++k) {
      const double difference = std::log(variance[k] / expected_variance(alpha, k + 1));
      sum += difference;
      squares += difference * difference;
    }
    const double n = static_cast<double>(distances);
    log_s2 = sum / n;
    return squares - sum * sum / n;
  };
  for (std::size_t k = 0; k < distances; ++k)
    if (!(variance[k] > 0)) return {0, 0};
  double best = 0, least = misfit(0);
  const auto attempt = [&](double alpha) {
    if (std::fabs(alpha) > alpha_limit) return;
    if (const double m = misfit(alpha); m < least) least = m, best = alpha;
  };
  for (int i = -18; i <= 18; ++i) attempt(0.05 * i);
  for (double step = 0.025; step > 1e-7; step /= 2) {
    const double about = best;
    attempt(about - step);
    attempt(about + step);
  }
  misfit(best);
  return {best, std::exp(log_s2) * (1 - best * best)};
}

/// An upper bound of the noise by sixth differences across rows, whose noise is independent: what
/// is smooth over seven rows, as what a tip draws, does not count. By their median, so that neither
/// do edges. 0: there are too few.
struct RowBound {
  double sigma_nm = 0;
  std::size_t places = 0;
};

RowBound bound_across_rows(const HeightField& field) {
  constexpr std::array<double, 7> binomial{1, -6, 15, -20, 15, -6, 1};
  constexpr double norm = 924;  // the sum of their squares
  constexpr std::size_t least_places = 400;
  const int width = field.z_nm.width(), height = field.z_nm.height();
  const int every = 1 + static_cast<int>(field.z_nm.size() / enough_centres);
  std::vector<double> sizes;
  for (int y = 0; y + 6 < height; y += every)
    for (int x = 0; x < width; ++x) {
      double difference = 0;
      bool whole = true;
      for (int k = 0; k < 7; ++k) {
        whole = whole && field.is_valid(x, y + k);
        if (whole) difference += binomial[static_cast<std::size_t>(k)] * field.z_nm(x, y + k);
      }
      if (whole) sizes.push_back(std::fabs(difference));
    }
  if (sizes.size() < least_places) return {};
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return {*middle / median_of_normal / std::sqrt(norm), sizes.size()};
}

/// Rough ground looks like noise that is strongly correlated along rows. Where the bound says for
/// certain that there is less, alpha is what the differences of neighbours then leave.
void apply(const RowBound& bound, double neighbours_variance, NoiseEstimate& estimate) {
  constexpr double clearly = 0.8, deviations = 4;
  if (!(bound.sigma_nm > 0)) return;
  const double s2 = bound.sigma_nm * bound.sigma_nm, q = neighbours_variance / (12 * s2),
               alpha = std::clamp(2 - std::sqrt(1 + q), -alpha_limit, alpha_limit),
               // Places overlap, and neighbours along rows tell less.
      independent =
          static_cast<double>(bound.places) / 7 * (1 - std::fabs(alpha)) / (1 + std::fabs(alpha)),
               share = 1.17 / std::sqrt(independent);  // of a median
  if (!(bound.sigma_nm * (1 + deviations * share) < clearly * estimate.sigma_nm())) return;
  estimate.noise = {alpha, s2 * (1 - alpha * alpha)};
  estimate.alpha_at_limit = false;
  estimate.sigma_stderr_nm = share * bound.sigma_nm;
}

}  // namespace

double NoiseEstimate::sigma_nm() const { return std::sqrt(noise.variance_nm2()); }

NoiseEstimate estimate_flat_noise(const HeightField& field, const FlatNoiseOptions& options,
                                  const Mask& use) {
  HeightField residual = field;
  subtract(residual, fit_polynomial(field, options.degree, use));
  const Covariances c = covariances(residual, use);
  const int terms = (options.degree + 1) * (options.degree + 2) / 2;
  if (c.samples < least_samples + static_cast<std::size_t>(terms) || c.pairs == 0)
    throw InvalidInput(
        "noise",
        fmt::format("{} samples and {} pairs beside each other take part", c.samples, c.pairs),
        "Use more of the image");
  if (c.r0 == 0) return with_errors(0, 0, c.samples);
  const double lost = removed_power(c.r0, c.r1, terms, c.samples);
  const double alpha = std::clamp((c.r1 + lost) / (c.r0 + lost), -highest_alpha, highest_alpha);
  return with_errors(c.r0 + lost, alpha, c.samples);
}

NoiseEstimate estimate_noise(const HeightField& field) {
  require_field(field, {});
  const Centres centres = mixed_differences(field);
  std::size_t count = 0;
  for (const auto& band : centres.bands) count += band.size();
  if (count == 0)
    throw InvalidInput("noise", "no 5 x 3 samples without holes are there to take differences of",
                       "Use a larger image, or fill its holes");
  const std::size_t none = centres.bands.size();
  Differences v{};
  for (std::size_t k = 0; k < centres.distances; ++k) v[k] = variance_from_median(centres, k);
  std::vector<BandSum> sums;
  for (int turn = 0; turn < 8; ++turn) {
    sums = clipped_sums(centres, v);
    v = variances(sums, none);
  }
  NoiseEstimate out;
  for (const BandSum& sum : sums) out.samples += sum.count;
  out.noise = fit_model(v, centres.distances);
  out.alpha_at_limit = std::fabs(out.noise.alpha) > alpha_limit - 1e-3;
  double alpha = 0, innovation = 0, sigma = 0;
  for (std::size_t b = 0; b < none; ++b) {
    const AfmNoise part = fit_model(variances(sums, none > 1 ? b : none), centres.distances);
    alpha += std::pow(part.alpha - out.noise.alpha, 2);
    innovation += std::pow(part.innovation_nm2 - out.noise.innovation_nm2, 2);
    sigma += std::pow(std::sqrt(part.variance_nm2()) - out.sigma_nm(), 2);
  }
  const double share = static_cast<double>(none - 1) / static_cast<double>(none);
  out.alpha_stderr = std::sqrt(share * alpha);
  out.innovation_stderr_nm2 = std::sqrt(share * innovation);
  out.sigma_stderr_nm = std::sqrt(share * sigma);
  apply(bound_across_rows(field), v[0], out);
  return out;
}

}  // namespace surf
