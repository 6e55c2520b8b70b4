// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/random.h"

namespace surf::test {

enum class WallShape {
  ramp,    ///< straight, of the stated width: these cases chose what the method is
  rounded  ///< an error function: these cases judge it
};

/// A made-up surface that is known between its samples: rough, tilted ground and pads with walls a
/// few nanometres wide at any angle.
class ChangingSurface {
 public:
  ChangingSurface(std::uint64_t seed, double size_nm, WallShape walls, double wall_nm = 3,
                  int pads = 5)
      : walls_(walls), wall_nm_(wall_nm) {
    RandomStream random(seed, 77, 0);
    const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
    constexpr int waves = 60;
    constexpr double rough_nm = 0.6, length_nm = 15;
    for (int i = 0; i < waves; ++i) {
      const double k = std::sqrt(-2 * std::log(random.uniform())) / length_nm;
      const double angle = between(0, 2 * std::numbers::pi);
      waves_.push_back({k * std::cos(angle), k * std::sin(angle), between(0, 2 * std::numbers::pi),
                        rough_nm * std::sqrt(2.0 / waves)});
    }
    for (int i = 0; i < pads; ++i)
      pads_.push_back({between(0, size_nm), between(0, size_nm), between(0.06, 0.15) * size_nm,
                       between(0.06, 0.15) * size_nm, between(0, std::numbers::pi),
                       between(15, 60)});
    tilt_x_ = between(-0.02, 0.02), tilt_y_ = between(-0.02, 0.02);
  }

  /// Something of this height comes to lie over a square.
  void add(double x_nm, double y_nm, double side_nm, double height_nm) {
    added_.push_back({x_nm, y_nm, 0.5 * side_nm, height_nm});
  }

  double height_nm(double x, double y) const {
    double z = tilt_x_ * x + tilt_y_ * y;
    for (const Wave& w : waves_) z += w.size * std::cos(w.x * x + w.y * y + w.phase);
    for (const Pad& p : pads_) {
      const double c = std::cos(p.angle), s = std::sin(p.angle);
      const double u = c * (x - p.x) + s * (y - p.y), v = -s * (x - p.x) + c * (y - p.y);
      z = std::max(z, z + p.height * wall(p.half_x - std::abs(u)) * wall(p.half_y - std::abs(v)));
    }
    for (const Square& q : added_)
      if (std::abs(x - q.x) <= q.half && std::abs(y - q.y) <= q.half) z += q.height;
    return z;
  }

 private:
  struct Wave {
    double x, y, phase, size;
  };
  struct Pad {
    double x, y, half_x, half_y, angle, height;
  };
  struct Square {
    double x, y, half, height;
  };

  /// 0 outside, 1 inside, by the distance to the edge.
  double wall(double inside_nm) const {
    if (walls_ == WallShape::ramp) return std::clamp(0.5 + inside_nm / wall_nm_, 0.0, 1.0);
    return 0.5 * std::erfc(-inside_nm / (0.4 * wall_nm_));
  }

  WallShape walls_;
  double wall_nm_, tilt_x_ = 0, tilt_y_ = 0;
  std::vector<Wave> waves_;
  std::vector<Pad> pads_;
  std::vector<Square> added_;
};

/// How a surface is measured.
struct Measuring {
  int width = 96, height = 96;
  double pitch_nm = 2;
  double x_nm = 0, y_nm = 0;  ///< the true place of sample (0, 0), which the file calls (0, 0)
  double noise_nm = 0.3;      ///< standard deviation
  double correlation_px = 0;  ///< standard deviation of the Gaussian that noise is blurred by
  double lift_nm = 0, tilt_x = 0, tilt_y = 0;
  std::uint64_t seed = 1;
};

/// Normal noise of variance 1, blurred and brought to variance 1 again.
inline Grid<double> blurred_noise(int width, int height, double sigma_px, std::uint64_t seed) {
  const int reach = int(std::ceil(4 * sigma_px)), w = width + 2 * reach, h = height + 2 * reach;
  RandomStream random(seed, 5, 0);
  Grid<double> white(w, h);
  for (double& v : white.data())
    v = std::sqrt(-2 * std::log(random.uniform())) *
        std::cos(2 * std::numbers::pi * random.uniform());
  std::vector<double> kernel;
  double squares = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(reach ? std::exp(-0.5 * k * k / (sigma_px * sigma_px)) : 1);
    squares += kernel.back() * kernel.back();
  }
  Grid<double> rows(width, h), out(width, height);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < width; ++x)
      for (int k = 0; k <= 2 * reach; ++k) rows(x, y) += kernel[std::size_t(k)] * white(x + k, y);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int k = 0; k <= 2 * reach; ++k)
        out(x, y) += kernel[std::size_t(k)] * rows(x, y + k) / squares;
  return out;
}

inline HeightField measured(const ChangingSurface& surface, const Measuring& m) {
  HeightField out;
  out.pitch_x_nm = out.pitch_y_nm = m.pitch_nm;
  out.z_nm = blurred_noise(m.width, m.height, m.correlation_px, m.seed);
  for (int y = 0; y < m.height; ++y)
    for (int x = 0; x < m.width; ++x) {
      const double u = x * m.pitch_nm, v = y * m.pitch_nm;
      out.z_nm(x, y) = m.noise_nm * out.z_nm(x, y) + surface.height_nm(m.x_nm + u, m.y_nm + v) +
                       m.lift_nm + m.tilt_x * u + m.tilt_y * v;
    }
  return out;
}

}  // namespace surf::test
