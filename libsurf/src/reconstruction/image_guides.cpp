// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_guides.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gaussian_basis.h"

namespace surf::reconstruction {
namespace {

constexpr double near_px = 1.2, far_px = 2.5;  // ranges over which slopes are averaged

/// The tangent of the steepest slope at each sample, from central differences.
Grid<double> slopes_of(const Grid<double>& z, double pitch_nm) {
  const int w = z.width(), h = z.height();
  Grid<double> slope(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int left = std::max(0, x - 1), right = std::min(w - 1, x + 1),
                below = std::max(0, y - 1), above = std::min(h - 1, y + 1);
      slope(x, y) = std::hypot((z(right, y) - z(left, y)) / (2 * pitch_nm),
                               (z(x, above) - z(x, below)) / (2 * pitch_nm));
    }
  return slope;
}

Grid<double> squared(Grid<double> values) {
  for (double& v : values.data()) v *= v;
  return values;
}

/// Of mean 0 and rms 1 where `used`. False if it is constant there.
bool normalise(Grid<double>& guide, const Mask& used) {
  double sum = 0, squares = 0, n = 0, largest = 0;
  for (std::size_t i = 0; i < guide.size(); ++i)
    if (used.data()[i]) sum += guide.data()[i], n += 1;
  if (n == 0) return false;
  const double mean = sum / n;
  for (std::size_t i = 0; i < guide.size(); ++i) {
    largest = std::max(largest, std::abs(guide.data()[i]));
    guide.data()[i] -= mean;
    if (used.data()[i]) squares += guide.data()[i] * guide.data()[i];
  }
  const double rms = std::sqrt(squares / n);
  if (!(rms > 1e-6 * largest)) return false;
  for (double& v : guide.data()) v /= rms;
  return true;
}

/// Takes off what `guide` has in common with `brightness`; both are normalised.
void take_off(Grid<double>& guide, const Grid<double>& brightness, const Mask& used) {
  double common = 0, n = 0;
  for (std::size_t i = 0; i < guide.size(); ++i)
    if (used.data()[i]) common += guide.data()[i] * brightness.data()[i], n += 1;
  for (std::size_t i = 0; i < guide.size(); ++i)
    guide.data()[i] -= common / n * brightness.data()[i];
}

}  // namespace

std::vector<Grid<double>> image_guides(const Grid<double>& z, double pitch_nm,
                                       const Grid<double>& simulated, const Mask& used,
                                       int threads) {
  const Grid<double> slope = slopes_of(z, pitch_nm),
                     slope_near = GaussianBasis(near_px, threads).sum(slope);
  Grid<double> brightness = simulated;
  const bool shows_something = normalise(brightness, used);
  std::vector<Grid<double>> all{squared(brightness), slope,
                                squared(slope),      slope_near,
                                squared(slope_near), GaussianBasis(far_px, threads).sum(slope)};
  std::vector<Grid<double>> out;
  for (Grid<double>& guide : all) {
    if (!normalise(guide, used)) continue;
    if (shows_something) take_off(guide, brightness, used);
    if (normalise(guide, used)) out.push_back(std::move(guide));
  }
  return out;
}

}  // namespace surf::reconstruction
