// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_prior.h"

#include <cmath>

namespace surf::reconstruction {
namespace {

/// Second differences divided by the pitch squared: along x and y at samples, mixed ones in the
/// cell to the upper right.
struct Differences {
  Grid<double> xx, yy, xy;

  Differences(const Grid<double>& z, double pitch_nm)
      : xx(z.width(), z.height()), yy(z.width(), z.height()), xy(z.width(), z.height()) {
    const double f = 1 / (pitch_nm * pitch_nm);
    const int w = z.width(), h = z.height();
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        if (x > 0 && x + 1 < w) xx(x, y) = f * (z(x - 1, y) - 2 * z(x, y) + z(x + 1, y));
        if (y > 0 && y + 1 < h) yy(x, y) = f * (z(x, y - 1) - 2 * z(x, y) + z(x, y + 1));
        if (x + 1 < w && y + 1 < h)
          xy(x, y) = f * (z(x, y) - z(x + 1, y) - z(x, y + 1) + z(x + 1, y + 1));
      }
  }

  /// The transpose.
  void scatter(double pitch_nm, Grid<double>& out) const {
    const double f = 1 / (pitch_nm * pitch_nm);
    const int w = xx.width(), h = xx.height();
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        double sum = -2 * (xx(x, y) + yy(x, y)) + xy(x, y);
        if (x > 0) sum += xx(x - 1, y) - xy(x - 1, y);
        if (x + 1 < w) sum += xx(x + 1, y);
        if (y > 0) sum += yy(x, y - 1) - xy(x, y - 1);
        if (y + 1 < h) sum += yy(x, y + 1);
        if (x > 0 && y > 0) sum += xy(x - 1, y - 1);
        out(x, y) += f * sum;
      }
  }
};

double squared(double v) { return v * v; }

/// c^2 of each sample. Each of the four cells around a sample has a z_xy; 2 z_xy^2 is half the sum
/// of their squares.
Grid<double> squares(const Grid<double>& xx, const Grid<double>& yy, const Grid<double>& xy) {
  Grid<double> out(xx.width(), xx.height());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      double mixed = squared(xy(x, y));
      if (x > 0) mixed += squared(xy(x - 1, y));
      if (y > 0) mixed += squared(xy(x, y - 1));
      if (x > 0 && y > 0) mixed += squared(xy(x - 1, y - 1));
      out(x, y) = squared(xx(x, y)) + squared(yy(x, y)) + 0.5 * mixed;
    }
  return out;
}

}  // namespace

double CurvaturePrior::evaluate(const Grid<double>& z, Grid<double>* gradient,
                                Grid<double>* weights) const {
  Differences d(z, pitch_nm_);
  const int w = z.width(), h = z.height();
  const double scale = degrees * curvature_ * curvature_;
  Grid<double> wanted;
  Grid<double>& weight = weights ? *weights : wanted;
  weight = squares(d.xx, d.yy, d.xy);
  double sum = 0;
  for (int y = 0; y < h; ++y) {
    double line = 0;
    for (int x = 0; x < w; ++x) {
      line += std::log1p(weight(x, y) / scale);
      weight(x, y) = (degrees + 1) / (scale + weight(x, y));
    }
    sum += line;
  }
  if (gradient) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        d.xx(x, y) *= weight(x, y);
        d.yy(x, y) *= weight(x, y);
        if (x + 1 < w && y + 1 < h) d.xy(x, y) *= cell_weight(weight, x, y);
      }
    d.scatter(pitch_nm_, *gradient);
  }
  return 0.5 * (degrees + 1) * sum;
}

double CurvaturePrior::likely_curvature_per_nm(const Grid<double>& z) const {
  const Grid<double> c2 = squared_curvature(z);
  const auto too_stiff = [&](double curvature) {
    double sum = 0;
    for (const double c : c2.data()) sum += c / (degrees * curvature * curvature + c);
    return sum > static_cast<double>(c2.size()) / (degrees + 1);
  };
  double low = 1e-9, high = 2e-9;
  while (too_stiff(high)) high *= 2;
  while (high > 1.001 * low) {
    const double middle = std::sqrt(low * high);
    (too_stiff(middle) ? low : high) = middle;
  }
  return high;
}

Grid<double> CurvaturePrior::squared_curvature(const Grid<double>& z) const {
  const Differences d(z, pitch_nm_);
  return squares(d.xx, d.yy, d.xy);
}

Grid<double> CurvaturePrior::weights_of(const Grid<double>& squared_curvature) const {
  Grid<double> w = squared_curvature;
  for (double& v : w.data()) v = (degrees + 1) / (degrees * curvature_ * curvature_ + v);
  return w;
}

void CurvaturePrior::add_product(const Grid<double>& weight, const Grid<double>& dz,
                                 Grid<double>& out) const {
  Differences d(dz, pitch_nm_);
  const int w = dz.width(), h = dz.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      d.xx(x, y) *= weight(x, y);
      d.yy(x, y) *= weight(x, y);
      if (x + 1 < w && y + 1 < h) d.xy(x, y) *= cell_weight(weight, x, y);
    }
  d.scatter(pitch_nm_, out);
}

}  // namespace surf::reconstruction
