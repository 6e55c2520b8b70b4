// SPDX-License-Identifier: GPL-3.0-or-later
// What SEM images of one surface differ by between tiers of physics and detectors, in the terms of
// `usual_discrepancy`: the source of its share and its correlation lengths.
//   bench_discrepancy FOLDER OTHER [FOLDER OTHER ...]
// Each pair are two folders that `semsurf sample` made of the same view with the same seed, but by
// other physics (--physics) or with another detector (--detector). The second image is fitted by a
// gain and an offset times the first. What is left, r, is not noise as far as neighbours agree: of
// two pixels a lag apart the noise is independent. So the mean of r r' over pairs of pixels at each
// lag from 1 to 24 pixels, along rows and columns, is fitted by the two parts of the discrepancy:
// a share of the contrast around a pixel, over 4 pixels, and a drift over 48. Printed: both shares,
// what they come to together over the image's contrast, and the lag at which r r' has fallen to
// half of that at lag 1. Last the rms over all pairs.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "chart/sample_truth.h"
#include "surf/reconstruction/reconstruct.h"

namespace {

using namespace surf;

constexpr int lags = 24;

struct Shares {
  double fine = 0, wide = 0, of_contrast = 0, half_lag_px = 0;
};

/// The correlation of a sum of quadratic B-splines with independent coefficients, `lag` apart: the
/// autocorrelation of a B-spline of degree 2, which is one of degree 5, averaged over its grid.
double correlation(double lag_px, double spacing_px) {
  const double t = std::abs(lag_px) / spacing_px;
  if (t >= 3) return 0;
  double sum = 0;
  constexpr std::array binomial{1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0};
  for (std::size_t k = 0; k < binomial.size(); ++k)
    sum += binomial[k] * std::pow(std::max(0.0, t + 3 - static_cast<double>(k)), 5);
  return sum / 66;  // its value at 0, times 120
}

/// Gain and offset of `to` by `from`, by products of neighbours, whose noise is independent.
std::array<double, 2> line_of(const Grid<double>& from, const Grid<double>& to) {
  const int w = from.width(), h = from.height();
  double mean_from = 0, mean_to = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    mean_from += from.data()[i], mean_to += to.data()[i];
  mean_from /= static_cast<double>(from.size()), mean_to /= static_cast<double>(from.size());
  double across = 0, square = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x + 1 < w; ++x) {
      const double a = from(x, y) - mean_from, b = from(x + 1, y) - mean_from;
      across += 0.5 * (a * (to(x + 1, y) - mean_to) + b * (to(x, y) - mean_to));
      square += a * b;
    }
  const double gain = across / square;
  return {gain, mean_to - gain * mean_from};
}

/// The mean of a(x) a(x + lag) along rows and columns, for lags from 1 on.
std::array<double, lags> products(const Grid<double>& a) {
  std::array<double, lags> out{};
  const int w = a.width(), h = a.height();
  for (int lag = 1; lag <= lags; ++lag) {
    double sum = 0, n = 0;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x + lag < w; ++x) sum += a(x, y) * a(x + lag, y), n += 1;
    for (int y = 0; y + lag < h; ++y)
      for (int x = 0; x < w; ++x) sum += a(x, y) * a(x, y + lag), n += 1;
    out[static_cast<std::size_t>(lag - 1)] = sum / n;
  }
  return out;
}

Shares compare(const workflow::SampleTruth& one, const workflow::SampleTruth& other) {
  const Grid<double>&from = one.sem.image.values, &to = other.sem.image.values;
  if (from.width() != to.width() || from.height() != to.height())
    throw std::runtime_error("the two images differ in size");
  const auto [gain, offset] = line_of(from, to);
  Grid<double> left = to;
  for (std::size_t i = 0; i < left.size(); ++i) left.data()[i] -= offset + gain * from.data()[i];
  const std::vector<SemDiscrepancy> parts = usual_discrepancy(other.sem.image, 1);
  const auto found = products(left);
  std::array<std::array<double, lags>, 2> by;
  for (std::size_t p = 0; p < by.size(); ++p) {
    by[p] = products(parts[p].deviation);
    for (int lag = 1; lag <= lags; ++lag)
      by[p][static_cast<std::size_t>(lag - 1)] *= correlation(lag, parts[p].correlation_px);
  }
  // Least squares of two numbers that are not negative.
  double a = 0, b = 0, c = 0, u = 0, v = 0;
  for (std::size_t i = 0; i < lags; ++i) {
    a += by[0][i] * by[0][i], b += by[0][i] * by[1][i], c += by[1][i] * by[1][i];
    u += by[0][i] * found[i], v += by[1][i] * found[i];
  }
  double fine = (c * u - b * v) / (a * c - b * b), wide = (a * v - b * u) / (a * c - b * b);
  if (wide < 0) wide = 0, fine = u / a;
  if (fine < 0) fine = 0, wide = std::max(0.0, v / c);
  Shares out;
  out.fine = std::sqrt(fine), out.wide = std::sqrt(wide);
  const auto contrast = products([&] {
    Grid<double> from_mean = to;
    double mean = 0;
    for (const double t : to.data()) mean += t / static_cast<double>(to.size());
    for (double& t : from_mean.data()) t -= mean;
    return from_mean;
  }());
  out.of_contrast = std::sqrt(std::max(0.0, found[0]) / contrast[0]);
  out.half_lag_px = lags;
  for (std::size_t i = lags; i-- > 0;)
    if (found[i] < 0.5 * found[0]) out.half_lag_px = static_cast<double>(i + 1);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc % 2 == 0) {
    fmt::print(stderr, "bench_discrepancy FOLDER OTHER [FOLDER OTHER ...]\n");
    return 2;
  }
  fmt::print("{:<28} {:<28} {:>8} {:>8} {:>12} {:>10}\n", "", "", "share, %", "drift, %",
             "contrast, %", "half at px");
  double fine = 0, wide = 0, contrast = 0;
  for (int i = 1; i + 1 < argc; i += 2) {
    const Shares s = compare(workflow::read_sample(argv[i]), workflow::read_sample(argv[i + 1]));
    fmt::print("{:<28} {:<28} {:8.1f} {:8.1f} {:12.1f} {:10.0f}\n", argv[i], argv[i + 1],
               100 * s.fine, 100 * s.wide, 100 * s.of_contrast, s.half_lag_px);
    fine += s.fine * s.fine, wide += s.wide * s.wide;
    contrast += s.of_contrast * s.of_contrast;
  }
  const double pairs = (argc - 1) / 2;
  fmt::print("{:<57} {:8.1f} {:8.1f} {:12.1f}\n", "rms of all", 100 * std::sqrt(fine / pairs),
             100 * std::sqrt(wide / pairs), 100 * std::sqrt(contrast / pairs));
}
