// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/training/training_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surf/mesh/shapes.h"

namespace surf {
namespace {

// Stream number that nothing else uses with the same seed.
constexpr std::uint64_t stream = 0x7e5a;

struct Block {
  double x_nm, y_nm, half_width_nm, half_depth_nm, turn, run_nm, height_nm;
  bool round;

  double at(double x, double y) const {
    const double c = std::cos(turn), s = std::sin(turn);
    const double u = (x - x_nm) * c + (y - y_nm) * s, v = (y - y_nm) * c - (x - x_nm) * s;
    const double outside =
        round ? (std::hypot(u / half_width_nm, v / half_depth_nm) - 1) * half_width_nm
              : std::max(std::abs(u) - half_width_nm, std::abs(v) - half_depth_nm);
    return height_nm * std::clamp(1 - outside / run_nm, 0.0, 1.0);
  }
};

template <class Change>
void change(HeightField& field, const Change& f) {
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x) {
      double& z = field.z_nm(x, y);
      z = f(field.x_nm(x), field.y_nm(y), z);
    }
}

}  // namespace

TrainingShapes::TrainingShapes(double pixel_nm, int size_px, std::uint64_t seed, int surface)
    : pixel_nm_(pixel_nm), size_px_(size_px), half_nm_(0.5 * size_px * pixel_nm),
      random_(seed, static_cast<std::uint64_t>(surface), stream) {}

double TrainingShapes::uniform(double from, double to) {
  return from + (to - from) * random_.uniform();
}

std::uint64_t TrainingShapes::seed() {
  const std::uint64_t high = random_.bits();
  return high << 32 | random_.bits();
}

HeightField TrainingShapes::flat() const {
  const double first = -0.5 * (size_px_ - 1) * pixel_nm_;
  return {{pixel_nm_, pixel_nm_, first, first}, Grid<double>(size_px_, size_px_)};
}

HeightField TrainingShapes::blocks(int count, double highest_nm) {
  HeightField field = flat();
  const double p = pixel_nm_;
  const double widest = std::max(std::min(40.0, 0.28 * half_nm_), 6 * p);
  const double deepest = std::max(std::min(60.0, 0.42 * half_nm_), 9 * p);
  for (int i = 0; i < count; ++i) {
    Block block{};
    block.x_nm = uniform(-half_nm_, half_nm_);
    block.y_nm = uniform(-half_nm_, half_nm_);
    block.half_width_nm = uniform(2 * p, widest);
    block.half_depth_nm = uniform(2 * p, deepest);
    block.turn = uniform(0, 3) < 1 ? uniform(0, std::numbers::pi) : 0;
    const double wall = uniform(0, 3);
    block.run_nm = wall < 1 ? p : wall < 2 ? 2 * p : uniform(p, 6 * p);
    block.height_nm = uniform(std::min(5.0, 0.5 * highest_nm), highest_nm);
    block.round = uniform(0, 1) < 0.3;
    const bool stacked = uniform(0, 1) >= 0.6;
    change(field, [&](double x, double y, double z) {
      const double b = block.at(x, y);
      return stacked ? z + b : std::max(z, b);
    });
  }
  return field;
}

HeightField TrainingShapes::island(double highest_nm) {
  HeightField field = flat();
  const double p = pixel_nm_, widest = std::min(14 * p, 0.4 * half_nm_);
  const int count = uniform(0, 1) < 0.5 ? 1 : 2;
  for (int i = 0; i < count; ++i) {
    Block block{};
    block.x_nm = uniform(-0.5, 0.5) * half_nm_;
    block.y_nm = uniform(-0.5, 0.5) * half_nm_;
    block.half_width_nm = uniform(2 * p, widest);
    block.half_depth_nm = uniform(2 * p, widest);
    block.turn = uniform(0, 2) < 1 ? uniform(0, std::numbers::pi) : 0;
    block.run_nm = run();
    block.height_nm = uniform(0.2 * highest_nm, highest_nm);
    block.round = uniform(0, 1) < 0.3;
    change(field, [&](double x, double y, double z) { return std::max(z, block.at(x, y)); });
  }
  return field;
}

HeightField TrainingShapes::line(double highest_nm) {
  const double turn = uniform(0, std::numbers::pi), c = std::cos(turn), s = std::sin(turn);
  const double at = uniform(-0.4, 0.4) * half_nm_, half = uniform(2, 10) * pixel_nm_, wall = run();
  const double height = uniform(0.2 * highest_nm, highest_nm);
  HeightField field = flat();
  change(field, [&](double x, double y, double) {
    return height * std::clamp(1 - (std::abs(x * c + y * s - at) - half) / wall, 0.0, 1.0);
  });
  return field;
}

HeightField TrainingShapes::outline() {
  const double length = uniform(8, 22) * pixel_nm_, level = uniform(-0.6, 0.9);
  HeightField field = rough(1, length);
  const Grid<double> z = field.z_nm;
  const int last = size_px_ - 1;
  for (int y = 0; y <= last; ++y)
    for (int x = 0; x <= last; ++x) {
      const int l = std::max(x - 1, 0), r = std::min(x + 1, last), b = std::max(y - 1, 0),
                t = std::min(y + 1, last);
      const double slope =
          std::hypot((z(r, y) - z(l, y)) / (r - l), (z(x, t) - z(x, b)) / (t - b)) / pixel_nm_;
      // Limits the distance where the random field is level.
      field.z_nm(x, y) = (z(x, y) - level) / std::hypot(slope, 0.2 / length);
    }
  return field;
}

HeightField TrainingShapes::pattern(double highest_nm) {
  const double height = uniform(0.2 * highest_nm, highest_nm), blur = uniform(0.7, 3) * pixel_nm_;
  HeightField field = outline();
  for (double& z : field.z_nm.data())
    z = 0.5 * height * (1 + std::erf(z / (std::numbers::sqrt2 * blur)));
  return field;
}

HeightField TrainingShapes::trace(double highest_nm) {
  const double height = uniform(0.2 * highest_nm, highest_nm), blur = uniform(0.7, 3) * pixel_nm_;
  const double half = uniform(1.5, 8) * pixel_nm_;
  HeightField field = outline();
  for (double& z : field.z_nm.data())
    z = 0.5 * height *
        (std::erf((half - z) / (std::numbers::sqrt2 * blur)) +
         std::erf((half + z) / (std::numbers::sqrt2 * blur)));
  return field;
}

double TrainingShapes::run() {
  constexpr double pixels[] = {1, 2, 3, 5};
  return pixels[std::min(3, static_cast<int>(uniform(0, 4)))] * pixel_nm_;
}

HeightField TrainingShapes::bumps(int count) {
  HeightField field = flat();
  for (int i = 0; i < count; ++i) {
    const double sigma = std::exp(uniform(std::log(2 * pixel_nm_), std::log(12 * pixel_nm_)));
    const double height = uniform(-1.5, 2) * sigma;
    const double cx = uniform(-half_nm_, half_nm_), cy = uniform(-half_nm_, half_nm_);
    change(field, [&](double x, double y, double z) {
      const double r2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      return z + height * std::exp(-0.5 * r2 / (sigma * sigma));
    });
  }
  return field;
}

HeightField TrainingShapes::lines(double highest_nm) {
  HeightField field = flat();
  const double turn = uniform(0, std::numbers::pi), c = std::cos(turn), s = std::sin(turn);
  for (double at = -1.5 * half_nm_; at < 1.5 * half_nm_;) {
    const double width = uniform(3, 16) * pixel_nm_, run = uniform(1, 4) * pixel_nm_;
    const double height = uniform(0.3, 1) * highest_nm;
    change(field, [&](double x, double y, double z) {
      const double outside = std::abs(x * c + y * s - at) - 0.5 * width;
      return std::max(z, height * std::clamp(1 - outside / run, 0.0, 1.0));
    });
    at += width + uniform(5, 25) * pixel_nm_;
  }
  return field;
}

HeightField TrainingShapes::pyramids(int count, double highest_nm) {
  HeightField field = flat();
  for (int i = 0; i < count; ++i) {
    const double cx = uniform(-half_nm_, half_nm_), cy = uniform(-half_nm_, half_nm_);
    const double slope = std::tan(uniform(10, 80) * std::numbers::pi / 180);
    const double height = uniform(highest_nm / 6, highest_nm);
    change(field, [&](double x, double y, double z) {
      return std::max(z, height - slope * std::max(std::abs(x - cx), std::abs(y - cy)));
    });
  }
  return field;
}

double TrainingShapes::shortened(double correlation_nm) const {
  return std::min(correlation_nm, 0.8 * half_nm_);
}

HeightField TrainingShapes::rough(double rms_nm, double correlation_nm) {
  const double across = (size_px_ - 1) * pixel_nm_;
  return make_rough({across, across, pixel_nm_}, rms_nm, shortened(correlation_nm), seed());
}

HeightField TrainingShapes::self_affine(double rms_nm, double correlation_nm, double hurst) {
  const double across = (size_px_ - 1) * pixel_nm_;
  return make_self_affine({across, across, pixel_nm_}, rms_nm, shortened(correlation_nm), hurst,
                          seed());
}

}  // namespace surf
