// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/substrate_noise.h"

#include <algorithm>
#include <cmath>

#include "afm/samples.h"
#include "surf/afm/noise_check.h"

namespace surf {
namespace {

constexpr double deviations = 4;
constexpr double most_tolerances = 3;
constexpr int most_turns = 20;
constexpr double ground_correlation = 0.5;

/// Marks the samples within `limit` of 0 and returns their root mean square.
double mark(const HeightField& residual, const Mask& use, double limit, Mask& mask) {
  double squares = 0, count = 0;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const double z = residual.z_nm(x, y);
      mask(x, y) = is_used(residual, use, x, y) && std::fabs(z) <= limit;
      if (mask(x, y)) squares += z * z, ++count;
    }
  }
  return std::sqrt(squares / std::max(count, 1.0));
}

}  // namespace

SubstrateNoise estimate_substrate_noise(const HeightField& field, const FlatNoiseOptions& options,
                                        const Mask& use) {
  SubstrateNoise out;
  out.plane = find_plane(field, {.watch = options.watch}, use);
  HeightField residual = field;
  subtract(residual, out.plane.plane);
  out.substrate = out.plane.inliers;
  double limit = out.plane.tolerance_nm;
  for (int turn = 0; turn < most_turns; ++turn) {
    const double next = std::min(deviations * mark(residual, use, limit, out.substrate),
                                 most_tolerances * out.plane.tolerance_nm);
    if (!(next > limit)) break;
    limit = next;
  }
  out.estimate = estimate_flat_noise(field, options, out.substrate);
  const Grid<double> background = fit_polynomial(field, options.degree, out.substrate);
  out.residual_nm = Grid<double>(background.width(), background.height());
  std::size_t samples = 0;
  for (int y = 0; y < background.height(); ++y) {
    for (int x = 0; x < background.width(); ++x) {
      if (field.is_valid(x, y)) out.residual_nm(x, y) = field.z_nm(x, y) - background(x, y);
      samples += is_used(field, use, x, y);
    }
  }
  out.substrate_share = static_cast<double>(out.estimate.samples) / static_cast<double>(samples);
  return out;
}

bool is_rough_ground(const SubstrateNoise& found) {
  if (!(found.estimate.noise.innovation_nm2 > 0)) return false;
  const Grid<double> white = whiten(found.residual_nm, found.estimate.noise, found.substrate);
  NoiseCheckOptions options;
  options.lags = 1;
  const NoiseCheck check = check_noise(white, found.substrate, options);
  return !check.across.empty() && check.across.front().correlation > ground_correlation;
}

}  // namespace surf
