// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Scans that sweeps take tips from.

#include <cmath>
#include <cstdint>

#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/core/random.h"

namespace surf::limits {

/// Spikes of one pixel, 2 to 12 nm high, seen by a tip, with white noise. Pixels of 1 nm.
inline HeightField scan_of_spikes(const Tip& tip, int pixels, double noise_nm, std::uint64_t seed) {
  HeightField f;
  f.z_nm = Grid<double>(pixels, pixels);
  RandomStream random(seed, 0, 0);
  for (int k = 0; k < pixels * pixels / 60; ++k) {
    const int x = static_cast<int>(random.uniform() * pixels),
              y = static_cast<int>(random.uniform() * pixels);
    f.z_nm(x, y) = 2 + 10 * random.uniform();
  }
  f = dilate(f, tip);
  if (noise_nm > 0) {
    const Grid<double> e = simulate_noise({0, noise_nm * noise_nm}, pixels, pixels, seed + 100);
    for (std::size_t k = 0; k < e.size(); ++k) f.z_nm.data()[k] += e.data()[k];
  }
  return f;
}

/// How far a tip is off where the true one is less than `depth_nm` below its apex.
struct TipError {
  double rms_nm = 0, mean_nm = 0;  ///< mean: above 0 too blunt, below too sharp
};
inline TipError error_of(const Tip& estimate, const Tip& truth, double depth_nm) {
  TipError e;
  double n = 0;
  for (std::size_t k = 0; k < truth.z_nm.size(); ++k) {
    if (!(truth.z_nm.data()[k] >= -depth_nm)) continue;
    const double d = estimate.z_nm.data()[k] - truth.z_nm.data()[k];
    e.rms_nm += d * d, e.mean_nm += d, n += 1;
  }
  return {std::sqrt(e.rms_nm / n), e.mean_nm / n};
}

}  // namespace surf::limits
