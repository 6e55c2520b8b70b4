// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine_agreement.h"

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/sem/estimate_sem_noise.h"
#include "surf/sem/noise_of_residuals.h"

namespace surf::workflow {

std::optional<SemNoise> noise_of_flats(const PlacedImage& image) {
  try {
    return estimate_sem_noise(image).noise;
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

SemNoise noise_of_rest(const PlacedImage& image, const Grid<double>& simulated,
                       const RefinedViewState& s) {
  Grid<double> mean = simulated;
  for (double& v : mean.data()) v = s.gain * v + s.offset;
  return noise_of_residuals(image.values, mean, image.valid);
}

double correlation(const RefinedView& v) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t p = 0; p < v.measured.size(); ++p) {
    if (!v.used.includes(p)) continue;
    const double x = v.measured.data()[p], y = v.simulated.data()[p];
    ++n, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double va = aa - a * a / n, vb = bb - b * b / n;
  return va > 0 && vb > 0 ? (ab - a * b / n) / std::sqrt(va * vb) : 0;
}

double unexplained_share(const RefinedView& v, const RefinedViewState& s, const SemNoise& noise,
                         const Grid<double>& chance_in_noise, bool less_known_errors) {
  double n = 0, left = 0, sum = 0, squares = 0, chance = 0;
  const Grid<double> nothing(v.measured.width(), v.measured.height(), 0),
      first = less_known_errors ? simulation_error(v, s, v.first_half) : nothing,
      second = less_known_errors ? simulation_error(v, s, v.second_half) : nothing;
  for (std::size_t p = 0; p < v.measured.size(); ++p) {
    if (!v.used.includes(p)) continue;
    const auto off = [&](const Grid<double>& simulated, const Grid<double>& error) {
      return v.measured.data()[p] - s.gain * simulated.data()[p] - s.offset - error.data()[p];
    };
    const double mean = s.gain * v.simulated.data()[p] + s.offset;
    ++n, left += off(v.first_half, first) * off(v.second_half, second),
        chance += noise.variance(mean);
    if (!chance_in_noise.empty()) chance -= s.gain * s.gain * chance_in_noise.data()[p];
    sum += mean, squares += mean * mean;
  }
  const double contrast = squares / n - sum * sum / (n * n);
  return contrast > 0 ? std::sqrt(std::max(0.0, (left - chance) / n) / contrast) : 1;
}

}  // namespace surf::workflow
