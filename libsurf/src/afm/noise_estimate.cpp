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

Covariances covariances(const HeightField& residual, const Grid<unsigned char>& use) {
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

/// A least-squares polynomial takes away the noise's power at frequency 0, r(0) (1 + a) / (1 - a), once
/// for each of its coefficients (Brockwell and Davis 1991, 7.1): both covariances are low by the same.
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

// ---- of an image with structure ----

constexpr std::size_t distances = 4;   // k = 1 ... 4
constexpr int most_bands = 8;
constexpr std::size_t enough_centres = 1'000'000;

struct Bands {
  std::array<std::vector<std::vector<double>>, distances> of;   // |D_k| by k and band
};

/// |D_k| about every sample without holes around; rows are skipped where there are more than enough.
Bands mixed_differences(const HeightField& field) {
  const int width = field.z_nm.width(), height = field.z_nm.height();
  const int bands = std::clamp((height - 2) / 2, 1, most_bands);
  const int every = 1 + static_cast<int>(field.z_nm.size() / enough_centres);
  Bands out;
  for (auto& k : out.of) k.resize(static_cast<std::size_t>(bands));
  for (int y = 1; y + 1 < height; y += every) {
    const auto band = static_cast<std::size_t>(static_cast<long long>(y - 1) * bands / (height - 2));
    for (int k = 1; k <= static_cast<int>(distances); ++k) {
      for (int x = k; x + k < width; ++x) {
        double d = 0;
        bool whole = true;
        for (int j = -1; j <= 1 && whole; ++j) {
          whole = field.is_valid(x - k, y + j) && field.is_valid(x, y + j) && field.is_valid(x + k, y + j);
          const double along = field.z_nm(x - k, y + j) - 2 * field.z_nm(x, y + j) + field.z_nm(x + k, y + j);
          d += j == 0 ? -2 * along : along;
        }
        if (whole) out.of[static_cast<std::size_t>(k - 1)][band].push_back(std::fabs(d));
      }
    }
  }
  return out;
}

/// Variance from the median of |D|, of all bands but one (-1: of all).
double robust_variance(const std::vector<std::vector<double>>& bands, int without) {
  std::vector<double> all;
  for (int b = 0; b < static_cast<int>(bands.size()); ++b)
    if (b != without) all.insert(all.end(), bands[static_cast<std::size_t>(b)].begin(), bands[static_cast<std::size_t>(b)].end());
  if (all.empty()) return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  constexpr double median_of_normal = 0.67448975019608171;
  return (*middle / median_of_normal) * (*middle / median_of_normal);
}

/// var D_k / s^2 of an AR(1) process whose rows are independent.
double expected_variance(double alpha, std::size_t k) {
  const double a = std::pow(alpha, static_cast<double>(k));
  return 12 * (1 - a) * (3 - a);
}

/// Least squares of the logarithms: on a lattice of alpha, then between its neighbours.
AfmNoise fit_model(const Bands& d, int without) {
  std::vector<std::pair<std::size_t, double>> measured;   // k, log of the variance
  for (std::size_t k = 1; k <= distances; ++k) {
    const double v = robust_variance(d.of[k - 1], without);
    if (v > 0) measured.emplace_back(k, std::log(v));
  }
  if (measured.empty()) return {0, 0};
  double log_variance = 0;
  const auto misfit = [&](double alpha) {
    double sum = 0, squares = 0;
    for (const auto& [k, v] : measured) {
      const double difference = v - std::log(expected_variance(alpha, k));
      sum += difference;
      squares += difference * difference;
    }
    const double n = static_cast<double>(measured.size());
    log_variance = sum / n;
    return squares - sum * sum / n;
  };
  double best = 0, least = misfit(0), step = 0.02;
  if (measured.size() > 1) {
    for (int i = -48; i <= 49; ++i)
      if (const double m = misfit(i * step); m < least) least = m, best = i * step;
    for (; step > 1e-7; step /= 2)
      for (const double alpha : {best - step / 2, best + step / 2})
        if (const double m = misfit(alpha); std::fabs(alpha) < highest_alpha && m < least) least = m, best = alpha;
  }
  misfit(best);
  return {best, std::exp(log_variance) * (1 - best * best)};
}

}  // namespace

double NoiseEstimate::sigma_nm() const { return std::sqrt(noise.variance_nm2()); }

NoiseEstimate estimate_flat_noise(const HeightField& field, const FlatNoiseOptions& options,
                                  const Grid<unsigned char>& use) {
  HeightField residual = field;
  subtract(residual, fit_polynomial(field, options.degree, use));
  const Covariances c = covariances(residual, use);
  const int terms = (options.degree + 1) * (options.degree + 2) / 2;
  if (c.samples < least_samples + static_cast<std::size_t>(terms) || c.pairs == 0)
    throw InvalidInput("noise", fmt::format("{} samples and {} pairs beside each other take part", c.samples, c.pairs),
                       "Use more of the image");
  if (c.r0 == 0) return with_errors(0, 0, c.samples);
  const double lost = removed_power(c.r0, c.r1, terms, c.samples);
  const double alpha = std::clamp((c.r1 + lost) / (c.r0 + lost), -highest_alpha, highest_alpha);
  return with_errors(c.r0 + lost, alpha, c.samples);
}

NoiseEstimate estimate_noise(const HeightField& field) {
  require_field(field, {});
  const Bands d = mixed_differences(field);
  NoiseEstimate out;
  for (const auto& band : d.of[1]) out.samples += band.size();
  if (out.samples == 0)
    throw InvalidInput("noise", "no 5 x 3 samples without holes are there to take differences of",
                       "Use a larger image, or fill its holes");
  out.noise = fit_model(d, -1);
  const int bands = static_cast<int>(d.of[0].size());
  if (bands < 2) return out;
  double alpha = 0, innovation = 0, sigma = 0;
  for (int b = 0; b < bands; ++b) {
    const AfmNoise part = fit_model(d, b);
    alpha += std::pow(part.alpha - out.noise.alpha, 2);
    innovation += std::pow(part.innovation_nm2 - out.noise.innovation_nm2, 2);
    sigma += std::pow(std::sqrt(part.variance_nm2()) - out.sigma_nm(), 2);
  }
  const double spread = (bands - 1) / static_cast<double>(bands);
  out.alpha_stderr = std::sqrt(spread * alpha);
  out.innovation_stderr_nm2 = std::sqrt(spread * innovation);
  out.sigma_stderr_nm = std::sqrt(spread * sigma);
  return out;
}

}  // namespace surf
