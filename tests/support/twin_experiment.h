// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/core/random.h"

namespace surf::test {

/// Scans of known surfaces by a known tip: the experiment of Matsunaga et al., Sci. Rep. 13 (2023),
/// made anew. 20 frames of 30 x 30 pixels of 1.5 nm; in each a heap of atoms, 1 to 7 nm high, on a
/// plane.
struct TwinExperiment {
  std::vector<HeightField> surfaces, scans;
  Tip tip;
  Grid<long> touched;  ///< per sample of the tip: pixels of the noiseless scans that it touches in

  /// Of an estimate of the same size, root mean square over the samples that touched, nm.
  double error_of(const Tip& estimate) const {
    double squares = 0, n = 0;
    for (int j = 0; j < tip.z_nm.height(); ++j)
      for (int i = 0; i < tip.z_nm.width(); ++i) {
        if (touched(i, j) == 0) continue;
        const double d = estimate.z_nm(i, j) - tip.z_nm(i, j);
        squares += d * d;
        n += 1;
      }
    return std::sqrt(squares / n);
  }
};

/// A ball of 2 nm radius on a cone of 20 degrees half angle; `apart_nm` > 0: two of them that far
/// apart, the second 0.4 nm shorter.
inline Tip twin_tip(int size, double apart_nm) {
  Tip tip;
  tip.z_nm = Grid<double>(size, size);
  tip.pitch_x_nm = tip.pitch_y_nm = 1.5;
  tip.apex_x = tip.apex_y = size / 2;
  constexpr double radius = 2, half_angle = 20 * 3.14159265358979324 / 180;
  const auto ball = [&](double x, double y) {
    const double r = std::hypot(x, y), joint = radius * std::cos(half_angle);
    if (r < joint) return std::sqrt(radius * radius - r * r) - radius;
    return radius * std::sin(half_angle) - radius - (r - joint) / std::tan(half_angle);
  };
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const double x = 1.5 * (i - tip.apex_x), y = 1.5 * (j - tip.apex_y);
      tip.z_nm(i, j) = ball(x, y);
      if (apart_nm > 0) tip.z_nm(i, j) = std::max(tip.z_nm(i, j), ball(x - apart_nm, y) - 0.4);
    }
  return tip;
}

inline TwinExperiment twin_experiment(const AfmNoise& noise, double apart_nm, std::uint64_t seed,
                                      int frames = 20) {
  constexpr int pixels = 30, size = 13;
  TwinExperiment out;
  out.tip = twin_tip(size, apart_nm);
  out.touched = Grid<long>(size, size);
  for (int f = 0; f < frames; ++f) {
    RandomStream random(seed, static_cast<std::uint64_t>(f), 0);
    HeightField surface;
    surface.z_nm = Grid<double>(pixels, pixels);
    surface.pitch_x_nm = surface.pitch_y_nm = 1.5;
    for (int atom = 0; atom < 30; ++atom) {
      const double turn = 6.283185307 * random.uniform(), out_to = 9 * std::sqrt(random.uniform());
      const int x = pixels / 2 + static_cast<int>(std::lround(out_to * std::cos(turn)));
      const int y = pixels / 2 + static_cast<int>(std::lround(out_to * std::sin(turn)));
      surface.z_nm(x, y) = std::max(surface.z_nm(x, y), 1 + 6 * random.uniform());
    }
    const Grid<double> added =
        simulate_noise(noise, pixels, pixels, seed + 1000 + static_cast<std::uint64_t>(f));
    HeightField scan = surface;
    for (int y = 0; y < pixels; ++y)
      for (int x = 0; x < pixels; ++x) {
        double most = -std::numeric_limits<double>::infinity();
        int by_i = 0, by_j = 0;
        for (int j = 0; j < size; ++j)
          for (int i = 0; i < size; ++i) {
            const int sx = x - (i - out.tip.apex_x), sy = y - (j - out.tip.apex_y);
            if (sx < 0 || sy < 0 || sx >= pixels || sy >= pixels) continue;
            const double z = surface.z_nm(sx, sy) + out.tip.z_nm(i, j);
            if (z <= most) continue;
            most = z;
            by_i = i;
            by_j = j;
          }
        ++out.touched(by_i, by_j);
        scan.z_nm(x, y) = most + added(x, y);
      }
    out.surfaces.push_back(std::move(surface));
    out.scans.push_back(std::move(scan));
  }
  return out;
}

}  // namespace surf::test
