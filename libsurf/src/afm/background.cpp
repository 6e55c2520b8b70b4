// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "afm/cholesky.h"
#include "afm/samples.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

constexpr int highest_degree = 6;
constexpr int most_terms = (highest_degree + 1) * (highest_degree + 2) / 2;
using Powers = std::array<double, highest_degree + 1>;
using Terms = std::array<double, most_terms>;

/// Legendre polynomials at u, P_0 to P_degree.
Powers legendre(double u, int degree) {
  Powers p{1, u};
  for (int n = 1; n < degree; ++n) {
    const auto i = static_cast<std::size_t>(n);
    p[i + 1] = ((2 * n + 1) * u * p[i] - n * p[i - 1]) / (n + 1);
  }
  return p;
}

/// Products of Legendre polynomials over the rectangle around the samples used, which keeps the
/// normal equations well conditioned for any rectangle.
struct Basis {
  int degree, terms;
  double centre_x, centre_y, half_x, half_y;  // columns and rows

  Powers along_x(int x) const { return legendre((x - centre_x) / half_x, degree); }
  Powers along_y(int y) const { return legendre((y - centre_y) / half_y, degree); }
  Terms at(const Powers& px, const Powers& py) const {
    Terms t;
    std::size_t k = 0;
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j)
        t[k++] = px[static_cast<std::size_t>(i)] * py[static_cast<std::size_t>(j)];
    return t;
  }
};

struct Fit {
  Basis basis;
  double reference_nm;  // height of the first sample; sums of differences from it lose no digits
  std::vector<double> coefficients;
};

Basis basis_over_used(const HeightField& field, const Mask& use, int degree) {
  int x0 = std::numeric_limits<int>::max(), x1 = -1, y0 = x0, y1 = -1;
  std::size_t samples = 0;
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (is_used(field, use, x, y)) {
        x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
        ++samples;
      }
  const int terms = (degree + 1) * (degree + 2) / 2;
  if (samples < static_cast<std::size_t>(terms))
    throw InvalidInput("height field",
                       fmt::format("{} samples take part, a polynomial of degree {} needs {}",
                                   samples, degree, terms),
                       "Use more of the image, or a lower degree");
  return {degree,
          terms,
          0.5 * (x0 + x1),
          0.5 * (y0 + y1),
          std::max(0.5, 0.5 * (x1 - x0)),
          std::max(0.5, 0.5 * (y1 - y0))};
}

Fit fit(const HeightField& field, const Mask& use, int degree) {
  require_field(field, use);
  Fit out{basis_over_used(field, use, degree), 0, {}};
  const Basis& b = out.basis;
  const auto n = static_cast<std::size_t>(b.terms);
  std::vector<Powers> px;
  for (int x = 0; x < field.z_nm.width(); ++x) px.push_back(b.along_x(x));
  std::vector<double> normal(n * n, 0.0), right(n, 0.0);
  bool first = true;
  for (int y = 0; y < field.z_nm.height(); ++y) {
    const Powers py = b.along_y(y);
    for (int x = 0; x < field.z_nm.width(); ++x) {
      if (!is_used(field, use, x, y)) continue;
      if (first) out.reference_nm = field.z_nm(x, y);
      first = false;
      const Terms t = b.at(px[static_cast<std::size_t>(x)], py);
      const double z = field.z_nm(x, y) - out.reference_nm;
      for (std::size_t i = 0; i < n; ++i) {
        right[i] += t[i] * z;
        for (std::size_t j = 0; j <= i; ++j) normal[i * n + j] += t[i] * t[j];
      }
    }
  }
  if (!solve_cholesky(normal, right))
    throw InvalidInput(
        "height field",
        fmt::format("the samples that take part do not determine a polynomial of degree {}: they "
                    "lie on too few lines",
                    degree),
        "Use more of the image, or a lower degree");
  out.coefficients = std::move(right);
  return out;
}

double value(const Fit& f, const Powers& px, const Powers& py) {
  const Terms t = f.basis.at(px, py);
  double sum = f.reference_nm;
  for (std::size_t i = 0; i < f.coefficients.size(); ++i) sum += f.coefficients[i] * t[i];
  return sum;
}

}  // namespace

double Plane::tilt_deg() const {
  return std::atan(std::hypot(slope_x, slope_y)) / degrees_to_radians;
}

double Plane::uphill_deg() const {
  const double angle = std::atan2(slope_y, slope_x) / degrees_to_radians;
  return angle < 0 ? angle + 360 : angle;
}

Plane fit_plane(const HeightField& field, const Mask& use) {
  const Fit f = fit(field, use, 1);  // terms: 1, y, x
  Plane p;
  p.slope_x = f.coefficients[2] / (f.basis.half_x * field.pitch_x_nm);
  p.slope_y = f.coefficients[1] / (f.basis.half_y * field.pitch_y_nm);
  p.centre_x_nm = field.origin_x_nm + 0.5 * (field.z_nm.width() - 1) * field.pitch_x_nm;
  p.centre_y_nm = field.origin_y_nm + 0.5 * (field.z_nm.height() - 1) * field.pitch_y_nm;
  const double x = field.origin_x_nm + f.basis.centre_x * field.pitch_x_nm;
  const double y = field.origin_y_nm + f.basis.centre_y * field.pitch_y_nm;
  p.height_nm = f.reference_nm + f.coefficients[0] + p.slope_x * (p.centre_x_nm - x) +
                p.slope_y * (p.centre_y_nm - y);
  return p;
}

SlopeDoubt doubt_of_plane(const HeightField& field, const Mask& use) {
  constexpr int across = 4, blocks = across * across;
  const int w = field.z_nm.width(), h = field.z_nm.height();
  std::vector<Plane> planes;
  for (int block = 0; block < blocks; ++block) {
    Mask rest = use.empty() ? Mask(w, h, 1) : use;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        if (x * across / w == block % across && y * across / h == block / across) rest(x, y) = 0;
    try {
      planes.push_back(fit_plane(field, rest));
    } catch (const InvalidInput&) {  // that block holds nearly all samples
    }
  }
  SlopeDoubt doubt;
  const auto n = static_cast<double>(planes.size());
  const auto error = [&](double Plane::*slope) {
    double mean = 0, square = 0;
    for (const Plane& plane : planes) mean += plane.*slope / n;
    for (const Plane& plane : planes) square += std::pow(plane.*slope - mean, 2);
    return n > 1 ? std::sqrt(square * (n - 1) / n) : 0;
  };
  doubt.x = error(&Plane::slope_x);
  doubt.y = error(&Plane::slope_y);
  return doubt;
}

Grid<double> fit_polynomial(const HeightField& field, int degree, const Mask& use) {
  if (degree < 0 || degree > highest_degree)
    throw UsageError("degree", fmt::format("it is {}", degree),
                     fmt::format("Give 0 to {}", highest_degree));
  const Fit f = fit(field, use, degree);
  Grid<double> out(field.z_nm.width(), field.z_nm.height());
  std::vector<Powers> px;
  for (int x = 0; x < out.width(); ++x) px.push_back(f.basis.along_x(x));
  for (int y = 0; y < out.height(); ++y) {
    const Powers py = f.basis.along_y(y);
    for (int x = 0; x < out.width(); ++x) out(x, y) = value(f, px[static_cast<std::size_t>(x)], py);
  }
  return out;
}

void subtract(HeightField& field, const Plane& plane) {
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (field.is_valid(x, y)) field.z_nm(x, y) -= plane.at(field.x_nm(x), field.y_nm(y));
}

void subtract(HeightField& field, const Grid<double>& background) {
  require_field(field, {});
  if (background.width() != field.z_nm.width() || background.height() != field.z_nm.height())
    throw InvalidInput("background", "its size is not that of the heights",
                       "Fit it to the same field");
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (field.is_valid(x, y)) field.z_nm(x, y) -= background(x, y);
}

}  // namespace surf
