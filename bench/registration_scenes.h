// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/resample.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/affine.h"
#include "surf/core/placed_image.h"
#include "surf/core/random.h"
#include "surf/mesh/shapes.h"
#include "surf/sem/image_model.h"

namespace surf {

/// Pairs of an SEM image and the image simulated from an AFM scan of the same surface, whose map is
/// known. The SEM sees the true surface, with shot noise; the scan is dilated by a dull tip,
/// sampled at another pitch, noisy (AR(1)) and eroded: the two are not one image resampled.
struct RegistrationScene {
  PlacedImage sem, simulated;
  HeightField scan;    ///< the tip's image, as large as `simulated`, with a pitch twice as coarse
  HeightField seen;    ///< the heights that the SEM image shows, at its pixels
  Affine truth;        ///< SEM to AFM
  double overlap = 0;  ///< share of the smaller image
};

enum class Pattern {
  blocks,
  bumps,
  pits,
  rough,
  lines_with_ends,
  grating,
  dots,
  single_line,
  unrelated
};

inline const char* name_of(Pattern p) {
  constexpr const char* names[] = {"blocks",  "bumps", "pits",        "rough",    "lines with ends",
                                   "grating", "dots",  "single line", "unrelated"};
  return names[static_cast<int>(p)];
}

/// Patterns whose place cannot be known.
inline constexpr Pattern without_place[] = {Pattern::grating, Pattern::dots, Pattern::single_line,
                                            Pattern::unrelated};

class SceneMaker {
 public:
  SceneMaker(std::shared_ptr<const ImageModel> model, std::uint64_t seed)
      : model_(std::move(model)), random_(seed, 11, 3) {}

  /// `width` x `height` SEM pixels as large as the model's.
  RegistrationScene make(Pattern pattern, int width, int height, double least_overlap) {
    const double pitch = model_->scope().pixel_nm;
    const double across = pitch * (std::hypot(width, height) * 1.9 + 60);
    const HeightField surface = surface_of(pattern, across, pitch);
    RegistrationScene scene;
    const double afm_nm =
        pitch * std::sqrt(double(width) * height);  // the scan is a square as large
    AffineParts parts;
    for (;;) {
      parts.rotation_rad = uniform(-std::numbers::pi, std::numbers::pi);
      parts.scale_x = uniform(0.8, 1.25);
      parts.scale_y = uniform(0.8, 1.25);
      parts.shear = uniform(-0.05, 0.05);
      parts.shift_x_nm = uniform(-0.8, 0.8) * afm_nm;
      parts.shift_y_nm = uniform(-0.8, 0.8) * afm_nm;
      scene.truth = make_affine(parts);
      scene.overlap = overlap_of(scene.truth, width, height, pitch, afm_nm);
      if (scene.overlap >= least_overlap) break;
    }
    const HeightField seen =
        pattern == Pattern::unrelated ? surface_of(pattern, across, pitch) : surface;
    scene.sem = sem_image(seen, scene.truth, width, height, pitch);
    scene.seen = at_pixels(seen, scene.truth, scene.sem);
    add_afm(surface, afm_nm, pitch, scene);
    return scene;
  }

  double uniform(double from, double to) { return from + (to - from) * random_.uniform(); }

 private:
  double normal() {
    return std::sqrt(-2 * std::log(random_.uniform())) *
           std::cos(2 * std::numbers::pi * random_.uniform());
  }

  /// Share of the smaller image that lies in the other, by counting.
  static double overlap_of(const Affine& map, int width, int height, double pitch, double afm_nm) {
    int inside = 0, all = 0;
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i, ++all) {
        const Point2 q = map({(i / 39.0 - 0.5) * width * pitch, (j / 39.0 - 0.5) * height * pitch});
        inside += std::abs(q.x) <= afm_nm / 2 && std::abs(q.y) <= afm_nm / 2;
      }
    const double sem_area = std::abs(map.determinant()) * width * height * pitch * pitch;
    return double(inside) / all * std::max(1.0, sem_area / (afm_nm * afm_nm));
  }

  /// A box or a disc with walls 8 nm long, turned; its height at a place, 0 outside.
  static double block(double x, double y, double a, double b, double angle, bool round,
                      double height) {
    const double u = x * std::cos(angle) + y * std::sin(angle),
                 v = y * std::cos(angle) - x * std::sin(angle);
    const double inside = round ? (1 - std::hypot(u / a, v / b)) * std::min(a, b)
                                : std::min(a - std::abs(u), b - std::abs(v));
    return height * std::clamp(inside / 8 + 0.5, 0.0, 1.0);
  }

  HeightField surface_of(Pattern pattern, double across, double pitch) {
    HeightField z = make_self_affine({across, across, pitch}, 0.4, 20, 0.8,
                                     static_cast<std::uint64_t>(1e9 * random_.uniform()));
    const double half = across / 2;
    const auto add = [&](auto&& height) {
      for (int v = 0; v < z.z_nm.height(); ++v)
        for (int u = 0; u < z.z_nm.width(); ++u)
          z.z_nm(u, v) = height(z.z_nm(u, v), z.x_nm(u), z.y_nm(v));
    };
    const auto add_near = [&](double cx, double cy, double reach, auto&& height) {
      const int u0 = std::max(0, int((cx - reach - z.origin_x_nm) / pitch)),
                u1 = std::min(z.z_nm.width() - 1, int((cx + reach - z.origin_x_nm) / pitch) + 1);
      const int v0 = std::max(0, int((cy - reach - z.origin_y_nm) / pitch)),
                v1 = std::min(z.z_nm.height() - 1, int((cy + reach - z.origin_y_nm) / pitch) + 1);
      for (int v = v0; v <= v1; ++v)
        for (int u = u0; u <= u1; ++u)
          z.z_nm(u, v) = height(z.z_nm(u, v), z.x_nm(u) - cx, z.y_nm(v) - cy);
    };
    const double area = across * across / 1e6;  // um^2
    switch (pattern) {
      case Pattern::unrelated:
      case Pattern::blocks:
      case Pattern::pits:
        for (int i = 0; i < int(45 * area); ++i) {
          const double a = uniform(20, 80), b = uniform(20, 80), angle = uniform(0, 3.1),
                       height = uniform(15, 45);
          const bool round = uniform(0, 1) < 0.4;
          const double sign = pattern == Pattern::pits ? -1 : 1;
          add_near(uniform(-half, half), uniform(-half, half), 120,
                   [&](double old, double x, double y) {
                     return old + sign * std::max(0.0, block(x, y, a, b, angle, round, height) -
                                                           0.6 * std::max(0.0, sign * old));
                   });
        }
        break;
      case Pattern::bumps:
        for (int i = 0; i < int(90 * area); ++i) {
          const double s = uniform(12, 45), height = uniform(-30, 40);
          add_near(uniform(-half, half), uniform(-half, half), 4 * s,
                   [&](double old, double x, double y) {
                     return old + height * std::exp(-0.5 * (x * x + y * y) / (s * s));
                   });
        }
        break;
      case Pattern::rough: {
        const HeightField rough = make_rough({across, across, pitch}, 15, 60,
                                             static_cast<std::uint64_t>(1e9 * random_.uniform()));
        for (std::size_t i = 0; i < z.z_nm.size(); ++i) z.z_nm.data()[i] += rough.z_nm.data()[i];
        break;
      }
      case Pattern::lines_with_ends: {
        const double period = 200;
        for (double x = -half; x < half; x += period) {
          double y = -half;
          while (y < half) {
            const double length = uniform(300, 1100), cx = x, cy = y + length / 2;
            add_near(cx, cy, length / 2 + 60, [&](double old, double px, double py) {
              return std::max(old, block(px, py, 40, length / 2, 0, false, 40));
            });
            y += length + uniform(80, 250);
          }
        }
        break;
      }
      case Pattern::grating:
        add([&](double old, double x, double) {
          return old + block(std::remainder(x, 160), 0, 35, 1e9, 0, false, 30);
        });
        break;
      case Pattern::dots:
        add([&](double old, double x, double y) {
          return old + block(std::remainder(x, 150), std::remainder(y, 150), 40, 40, 0, true, 30);
        });
        break;
      case Pattern::single_line:
        add([&](double old, double x, double) { return old + block(x, 0, 60, 1e9, 0, false, 40); });
        break;
    }
    return z;
  }

  static double between(const Grid<double>& g, double u, double v) {  // Catmull and Rom's cubic
    const int i = std::clamp(int(std::floor(u)), 1, g.width() - 3),
              j = std::clamp(int(std::floor(v)), 1, g.height() - 3);
    const auto weights = [](double t, double* w) {
      w[0] = t * (-0.5 + t * (1 - 0.5 * t)), w[1] = 1 + t * t * (-2.5 + 1.5 * t);
      w[2] = t * (0.5 + t * (2 - 1.5 * t)), w[3] = t * t * (-0.5 + 0.5 * t);
    };
    double a[4], b[4], sum = 0;
    weights(u - i, a);
    weights(v - j, b);
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < 4; ++l) sum += b[k] * a[l] * g(i + l - 1, j + k - 1);
    return sum;
  }

  PlacedImage sem_image(const HeightField& surface, const Affine& map, int width, int height,
                        double pitch) {
    const Grid<double> ideal = model_->predict(surface)[0];
    PlacedImage image{{pitch, pitch, -0.5 * (width - 1) * pitch, -0.5 * (height - 1) * pitch},
                      Grid<double>(width, height)};
    double mean = 0;
    for (const double v : ideal.data()) mean += v / double(ideal.size());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Point2 q = map(image.place_nm(x, y));
        const double signal = between(ideal, (q.x - surface.origin_x_nm) / pitch,
                                      (q.y - surface.origin_y_nm) / pitch);
        // Shot noise of 40 electrons a pixel, and a little of the amplifier's; a microscope's grey
        // levels.
        const double noise = std::sqrt(std::max(0.0, signal) / 40 * 1.3 + 1e-4);
        image.values(x, y) = 30 + 120 * (signal + noise * normal()) / mean;
      }
    return image;
  }

  static HeightField at_pixels(const HeightField& surface, const Affine& map,
                               const PlacedImage& image) {
    HeightField out{image.placement(), Grid<double>(image.values.width(), image.values.height())};
    for (int y = 0; y < image.values.height(); ++y)
      for (int x = 0; x < image.values.width(); ++x) {
        const Point2 q = map(image.place_nm(x, y));
        out.z_nm(x, y) = between(surface.z_nm, (q.x - surface.origin_x_nm) / surface.pitch_x_nm,
                                 (q.y - surface.origin_y_nm) / surface.pitch_y_nm);
      }
    return out;
  }

  /// The scan, and the image that is simulated from it.
  void add_afm(const HeightField& surface, double afm_nm, double pitch, RegistrationScene& scene) {
    const int factor = 2;
    const double coarse = factor * pitch;
    // A margin, so that the tip sees what it would.
    const int n = int(afm_nm / coarse), margin = 10, full = n + 2 * margin;
    const TipSampling fine{pitch, pitch, 41, 41};
    const HeightField dilated = dilate(surface, conical_tip(15, 0.3, fine));
    HeightField scan{{coarse, coarse, -0.5 * (full - 1) * coarse, -0.5 * (full - 1) * coarse},
                     Grid<double>(full, full)};
    const Grid<double> noise = simulate_noise({0.825, 0.201}, full, full,
                                              static_cast<std::uint64_t>(1e9 * random_.uniform()));
    for (int y = 0; y < full; ++y)
      for (int x = 0; x < full; ++x)
        scan.z_nm(x, y) = between(dilated.z_nm, (scan.x_nm(x) - surface.origin_x_nm) / pitch,
                                  (scan.y_nm(y) - surface.origin_y_nm) / pitch) +
                          noise(x, y);
    const HeightField eroded =
        resampled(erode(scan, conical_tip(15, 0.3, {coarse, coarse, 21, 21})), pitch);
    const Grid<double> simulated = model_->predict(eroded)[0];
    const int cut = margin * factor, size = eroded.z_nm.width() - 2 * cut;
    scene.simulated = {
        {pitch, pitch, eroded.origin_x_nm + cut * pitch, eroded.origin_y_nm + cut * pitch},
        Grid<double>(size, size)};
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) scene.simulated.values(x, y) = simulated(x + cut, y + cut);
    scene.scan = {{coarse, coarse, scan.x_nm(margin), scan.y_nm(margin)}, Grid<double>(n, n)};
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) scene.scan.z_nm(x, y) = scan.z_nm(x + margin, y + margin);
  }

  std::shared_ptr<const ImageModel> model_;
  RandomStream random_;
};

/// The pair of this number and pattern: 456 x 172 and 300 x 300 SEM pixels in turn.
inline RegistrationScene numbered_scene(const std::shared_ptr<const ImageModel>& model, int number,
                                        Pattern pattern) {
  SceneMaker maker(model, 1000003 + 100000 * static_cast<std::uint64_t>(pattern) +
                              static_cast<std::uint64_t>(number));
  return number % 2 == 0 ? maker.make(pattern, 456, 172, 0.5) : maker.make(pattern, 300, 300, 0.5);
}

/// Calls read(line) for each line of a table of numbers, whose commas are blanks then. There is
/// none of a file that is missing.
template <class Read>
void for_each_row(const std::string& path, const Read& read) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    read(in);
  }
}

}  // namespace surf
