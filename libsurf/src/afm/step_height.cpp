// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/step_height.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "afm/cholesky.h"
#include "afm/samples.h"

namespace surf {
namespace {

constexpr std::size_t terms = 4;  // level, step, slope along x, slope along y
using Row = std::array<double, terms>;

class Regions {
 public:
  Regions(const HeightField& field, const Mask& first, const Mask& second)
      : field_(field), first_(first), second_(second),
        half_x_(std::max(1.0, 0.5 * (field.z_nm.width() - 1))),
        half_y_(std::max(1.0, 0.5 * (field.z_nm.height() - 1))) {}

  /// The row of the design matrix for a sample. Returns false if the sample is in neither region.
  bool row(int x, int y, Row& row) const {
    if (!field_.is_valid(x, y)) return false;
    const bool in_first = first_(x, y), in_second = second_(x, y);
    if (!in_first && !in_second) return false;
    if (in_first && in_second)
      throw InvalidInput("step", fmt::format("the regions overlap at column {}, row {}", x, y),
                         "Keep them apart");
    row = {1, in_second ? 1.0 : 0.0, x / half_x_ - 1, y / half_y_ - 1};
    return true;
  }
  double half_x() const { return half_x_; }
  double half_y() const { return half_y_; }

 private:
  const HeightField& field_;
  const Mask &first_, &second_;
  double half_x_, half_y_;
};

template <class Visit>
void each(const HeightField& field, const Regions& regions, const Visit& visit) {
  Row row;
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (regions.row(x, y, row)) visit(x, y, row);
}

double dot(const Row& a, const Row& b) {
  double sum = 0;
  for (std::size_t i = 0; i < terms; ++i) sum += a[i] * b[i];
  return sum;
}

struct Fit {
  std::vector<double> factor;  // Cholesky factor of X'X
  Row values{};
  double reference_nm = 0;
  std::size_t samples = 0;
};

Fit fit(const HeightField& field, const Regions& regions) {
  Fit f;
  f.factor.assign(terms * terms, 0.0);
  std::vector<double> right(terms, 0.0);
  double in_second = 0;
  each(field, regions, [&](int x, int y, const Row& row) {
    if (f.samples++ == 0) f.reference_nm = field.z_nm(x, y);
    in_second += row[1];
    for (std::size_t i = 0; i < terms; ++i) {
      right[i] += row[i] * (field.z_nm(x, y) - f.reference_nm);
      for (std::size_t j = 0; j <= i; ++j) f.factor[i * terms + j] += row[i] * row[j];
    }
  });
  if (in_second == 0 || in_second == static_cast<double>(f.samples))
    throw InvalidInput(
        "step",
        in_second == 0 ? "the second region holds no samples" : "the first region holds no samples",
        "Place it over the image, away from holes");
  if (f.samples <= terms || !solve_cholesky(f.factor, right))
    throw InvalidInput("step", "the regions do not determine a tilt and a step",
                       "Make them larger in both directions");
  std::copy(right.begin(), right.end(), f.values.begin());
  return f;
}

/// X' R X for R = alpha^|i - j| within rows, from a running sum over the samples to the left.
std::vector<double> correlated_squares(const HeightField& field, const Regions& regions,
                                       double alpha) {
  std::vector<double> out(terms * terms, 0.0);
  Row row;
  for (int y = 0; y < field.z_nm.height(); ++y) {
    Row before{};  // sum of alpha^distance times their rows over the samples to the left
    for (int x = 0; x < field.z_nm.width(); ++x) {
      for (double& b : before) b *= alpha;
      if (!regions.row(x, y, row)) continue;
      for (std::size_t i = 0; i < terms; ++i)
        for (std::size_t j = 0; j < terms; ++j)
          out[i * terms + j] += row[i] * row[j] + row[i] * before[j] + before[i] * row[j];
      for (std::size_t i = 0; i < terms; ++i) before[i] += row[i];
    }
  }
  return out;
}

void measure_residuals(const HeightField& field, const Regions& regions, const Fit& f,
                       StepHeight& s) {
  double squares = 0, products = 0;
  std::size_t pairs = 0;
  int last_x = -2, last_y = -1;
  double last = 0;
  each(field, regions, [&](int x, int y, const Row& row) {
    const double e = field.z_nm(x, y) - f.reference_nm - dot(row, f.values);
    squares += e * e;
    if (y == last_y && x == last_x + 1) products += e * last, ++pairs;
    last = e, last_x = x, last_y = y;
  });
  s.residual_nm = std::sqrt(squares / static_cast<double>(f.samples));
  if (pairs && squares > 0)
    s.alpha = std::clamp(
        products / static_cast<double>(pairs) / (squares / static_cast<double>(f.samples)), -0.99,
        0.99);
}

}  // namespace

StepHeight measure_step(const HeightField& field, const Mask& first, const Mask& second) {
  for (const auto* region : {&first, &second}) {
    if (region->empty()) throw InvalidInput("step", "a region is empty", "Give two masks");
    require_field(field, *region);
  }
  const Regions regions(field, first, second);
  const Fit f = fit(field, regions);
  StepHeight s;
  s.height_nm = f.values[1];
  s.slope_x = f.values[2] / (regions.half_x() * field.pitch_x_nm);
  s.slope_y = f.values[3] / (regions.half_y() * field.pitch_y_nm);
  s.samples = f.samples;
  measure_residuals(field, regions, f, s);
  // c is the row of (X'X)^-1 that belongs to the step; the variance of the step is c' X'RX c s^2.
  std::vector<double> c(terms, 0.0);
  c[1] = 1;
  solve_factored(f.factor, c);
  const std::vector<double> xrx = correlated_squares(field, regions, s.alpha);
  double variance = 0;
  for (std::size_t i = 0; i < terms; ++i)
    for (std::size_t j = 0; j < terms; ++j) variance += c[i] * xrx[i * terms + j] * c[j];
  const double n = static_cast<double>(f.samples);
  s.stderr_nm = s.residual_nm * std::sqrt(std::max(0.0, variance) * n / (n - terms));
  return s;
}

}  // namespace surf
