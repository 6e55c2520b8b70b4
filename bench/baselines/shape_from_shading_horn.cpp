// SPDX-License-Identifier: GPL-3.0-or-later
#include "shape_from_shading_horn.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "image_pyramid.h"

namespace surf::bench {
namespace {

double mean(const Grid<double>& z) {
  return std::accumulate(z.data().begin(), z.data().end(), 0.0) / static_cast<double>(z.size());
}

/// One level of the pyramid. Heights and pixels in units of its pixels.
class Level {
 public:
  Level(const Grid<double>& image, const ReflectanceMap& reflectance, const HornOptions& options)
      : image_(image), reflectance_(reflectance), options_(options), w_(image.width()),
        h_(image.height()) {}

  Grid<double> p, q;  // on pixels

  /// Heights of pixels, as means of their corners.
  Grid<double> heights() const {
    Grid<double> out(w_, h_);
    for (int y = 0; y < h_; ++y)
      for (int x = 0; x < w_; ++x)
        out(x, y) = (z_(x, y) + z_(x + 1, y) + z_(x, y + 1) + z_(x + 1, y + 1)) / 4;
    return out;
  }

  void set_heights(const Grid<double>& pixels) {
    z_ = Grid<double>(w_ + 1, h_ + 1);
    for (int y = 0; y <= h_; ++y)
      for (int x = 0; x <= w_; ++x) {
        const int l = std::max(x - 1, 0), r = std::min(x, w_ - 1), b = std::max(y - 1, 0),
                  t = std::min(y, h_ - 1);
        z_(x, y) = (pixels(l, b) + pixels(r, b) + pixels(l, t) + pixels(r, t)) / 4;
      }
  }

  void gradients_of_heights() {
    p = q = Grid<double>(w_, h_);
    for (int y = 0; y < h_; ++y)
      for (int x = 0; x < w_; ++x) p(x, y) = z_x(x, y), q(x, y) = z_y(x, y);
  }

  void relax(double smoothness) {
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
      const double moved = relax_gradients(smoothness);
      relax_heights();
      if (moved < options_.tolerance) return;
    }
  }

 private:
  double z_x(int x, int y) const {
    return (z_(x + 1, y) - z_(x, y) + z_(x + 1, y + 1) - z_(x, y + 1)) / 2;
  }
  double z_y(int x, int y) const {
    return (z_(x, y + 1) - z_(x, y) + z_(x + 1, y + 1) - z_(x + 1, y)) / 2;
  }

  /// A mean of the eight neighbours with the weights of Horn's Laplacian, 4 and 1.
  double around(const Grid<double>& f, int x, int y) const {
    const int l = std::max(x - 1, 0), r = std::min(x + 1, w_ - 1), b = std::max(y - 1, 0),
              t = std::min(y + 1, h_ - 1);
    return (4 * (f(l, y) + f(r, y) + f(x, b) + f(x, t)) + f(l, b) + f(r, b) + f(l, t) + f(r, t)) /
           20;
  }

  double relax_gradients(double smoothness) {
    constexpr double kappa = 10.0 / 3;  // Laplacian = kappa (mean around - own)
    const double stiff = kappa * smoothness, mu = options_.integrability, held = stiff + mu;
    double squares = 0;
    for (int y = 0; y < h_; ++y)
      for (int x = 0; x < w_; ++x) {
        double &px = p(x, y), &qx = q(x, y);
        const ReflectanceMap::Value r = reflectance_.at(px, qx);
        const double left = image_(x, y) - r.r;
        const double a = stiff * (around(p, x, y) - px) + mu * (z_x(x, y) - px) + left * r.by_p,
                     b = stiff * (around(q, x, y) - qx) + mu * (z_y(x, y) - qx) + left * r.by_q;
        // The inverse of held * 1 + grad R grad R^T.
        const double along = (a * r.by_p + b * r.by_q) / (held + r.by_p * r.by_p + r.by_q * r.by_q);
        const double dp = (a - along * r.by_p) / held, dq = (b - along * r.by_q) / held;
        px += dp, qx += dq;
        squares += dp * dp + dq * dq;
      }
    return std::sqrt(squares / static_cast<double>(p.size()));
  }

  /// Poisson's equation, Laplacian of z = p_x + q_y, one sweep of over-relaxation. It is the least
  /// of (z_x - p)^2 + (z_y - q)^2 of all pixels, which couples corners along diagonals alone: a
  /// constant between the two lattices is free, and is not seen in means of four corners.
  void relax_heights() {
    constexpr double over = 1.7;
    for (int y = 0; y <= h_; ++y)
      for (int x = 0; x <= w_; ++x) {
        double sum = 0;
        int count = 0;
        const auto add = [&](int dx, int dy) {
          const int px = dx > 0 ? x : x - 1, py = dy > 0 ? y : y - 1;  // the pixel between
          if (px < 0 || py < 0 || px >= w_ || py >= h_) return;
          sum += z_(x + dx, y + dy) - dx * p(px, py) - dy * q(px, py);
          ++count;
        };
        add(-1, -1), add(1, -1), add(-1, 1), add(1, 1);
        z_(x, y) += over * (sum / count - z_(x, y));
      }
  }

  const Grid<double>& image_;
  const ReflectanceMap& reflectance_;
  const HornOptions& options_;
  int w_, h_;
  Grid<double> z_;  // on corners
};

}  // namespace

Grid<double> shape_by_horn(const ShadedImage& image, const Grid<double>& start_nm,
                           const HornOptions& options, const HeightsSoFar& so_far) {
  const std::vector<Grid<double>> images = pyramid(image.relative, options.levels),
                                  starts = pyramid(start_nm, options.levels);
  Grid<double> z_nm = starts.front(), p, q;
  const double constant_nm = mean(start_nm);
  const auto finest = [&](Grid<double> z) {
    for (auto i = images.begin() + 1; i < images.end(); ++i)
      if (i->width() > z.width()) z = doubled(z, i->width(), i->height());
    const double off = constant_nm - mean(z);
    for (double& v : z.data()) v += off;
    return z;
  };
  double pitch_nm = image.pitch_nm * static_cast<double>(1 << (images.size() - 1));
  for (const Grid<double>& own : images) {
    Level level(own, image.reflectance, options);
    z_nm = refined(std::move(z_nm), own.width(), own.height());
    Grid<double> z = z_nm;
    for (double& v : z.data()) v /= pitch_nm;
    level.set_heights(z);
    if (p.empty()) {
      level.gradients_of_heights();
    } else {
      level.p = refined(std::move(p), own.width(), own.height());
      level.q = refined(std::move(q), own.width(), own.height());
    }
    for (double s = options.first_smoothness; s > 0.99 * options.last_smoothness; s /= 2) {
      level.relax(s);
      z_nm = level.heights();
      for (double& v : z_nm.data()) v *= pitch_nm;
      if (so_far) so_far(finest(z_nm));
    }
    p = std::move(level.p);
    q = std::move(level.q);
    pitch_nm /= 2;
  }
  return finest(std::move(z_nm));
}

}  // namespace surf::bench
