// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "reconstruction/initial_surface.h"

namespace surf::bench {
namespace {

using namespace reconstruction;

constexpr int margin_px = 4, threads = 1;
constexpr double last_scale_px = 1.4, curvature_per_nm = 1e-3;

/// The pixel that the square with the greatest sum begins at.
std::pair<int, int> place_of_most(const Grid<double>& squares, int side) {
  double most = -1;
  std::pair<int, int> place;
  for (int y = margin_px; y + side + margin_px <= squares.height(); ++y)
    for (int x = margin_px; x + side + margin_px <= squares.width(); ++x) {
      double sum = 0;
      for (int v = y; v < y + side; ++v)
        for (int u = x; u < x + side; ++u) sum += squares(u, v);
      if (sum > most) most = sum, place = {x, y};
    }
  return place;
}

/// Tensor products of uniform cubic B-splines on the samples of a surface.
class Splines {
 public:
  Splines(const SurfaceFrame& frame, int spacing)
      : width_(frame.width), height_(frame.height), spacing_(spacing), across_(count(frame.width)),
        along_(count(frame.height)) {}

  std::size_t numbers() const { return static_cast<std::size_t>(across_) * along_; }

  std::vector<double> added(std::vector<double> z, const double* c) const {
    for_each([&](std::size_t sample, std::size_t number, double weight) {
      z[sample] += weight * c[number];
    });
    return z;
  }
  void transposed(const std::vector<double>& by_height, double* out) const {
    std::fill_n(out, numbers(), 0.0);
    for_each([&](std::size_t sample, std::size_t number, double weight) {
      out[number] += weight * by_height[sample];
    });
  }

 private:
  int count(int samples) const { return (samples - 1) / spacing_ + 4; }

  std::array<double, 4> weights(int sample) const {
    const double t = sample % spacing_ / static_cast<double>(spacing_), s = 1 - t;
    return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
            t * t * t / 6};
  }

  template <class Entry>
  void for_each(const Entry& entry) const {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const std::array<double, 4> wx = weights(x), wy = weights(y);
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i)
            entry(static_cast<std::size_t>(y) * width_ + x,
                  static_cast<std::size_t>(y / spacing_ + j) * across_ + x / spacing_ + i,
                  wx[i] * wy[j]);
      }
  }

  int width_, height_, spacing_, across_, along_;
};

}  // namespace

Grid<double> SmallScene::on_pixels(const std::vector<double>& z_nm) const {
  Grid<double> all(objective.frame.width, objective.frame.height);
  std::ranges::copy(z_nm, all.data().begin());
  return cut_out(all, margin, margin, truth_nm.width(), truth_nm.height());
}

double SmallScene::off_nm(const std::vector<double>& z_nm) const {
  const Grid<double> z = on_pixels(z_nm);
  double sum = 0;
  for (std::size_t i = 0; i < z.size(); ++i) sum += std::pow(z.data()[i] - truth_nm.data()[i], 2);
  return std::sqrt(sum / static_cast<double>(z.size()));
}

SmallScene small_scene(const workflow::SampleTruth& sample, int side) {
  const HeightField outside = eroded(sample.afm, threads);
  const PlacedImage& whole = sample.sem.image;
  Grid<double> squares =
      on_frame(outside, frame_of(nullptr, &sample.sem, 0), sample.sem.sem_to_afm);
  for (std::size_t i = 0; i < squares.size(); ++i)
    squares.data()[i] = std::pow(squares.data()[i] - sample.truth.z_nm.data()[i], 2);
  const auto [left, below] = place_of_most(squares, side);
  SemData sem = sample.sem;
  sem.image.values = cut_out(whole.values, left, below, side, side);
  sem.image.valid = {};
  sem.image.origin_x_nm = whole.origin_x_nm + left * whole.pitch_x_nm;
  sem.image.origin_y_nm = whole.origin_y_nm + below * whole.pitch_y_nm;
  const SurfaceFrame frame = frame_of(&sample.afm, &sem, margin_px);
  SmallScene scene{
      .objective = {.prior = CurvaturePrior(frame.pitch_nm,
                                            curvature_per_nm * last_scale_px * last_scale_px),
                    .frame = frame},
      .start = {on_frame(outside, frame, sem.sem_to_afm), sem.sem_to_afm, {sem.gains, sem.offset}},
      .truth_nm = cut_out(sample.truth.z_nm, left, below, side, side),
      .margin = margin_px};
  scene.objective.afm.emplace(sample.afm, outside, frame, sem.sem_to_afm, threads);
  scene.objective.sem.emplace(sem, frame, margin_px, margin_px, threads);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      scene.most_off_nm =
          std::max(scene.most_off_nm,
                   std::abs(scene.start.z_nm(x, y) -
                            sample.truth.z_nm(left - margin_px + x, below - margin_px + y)));
  return scene;
}

HeightBox box_of(const SmallScene& scene, int spacing) {
  constexpr double wider = 1.5;
  const std::vector<double>& start = scene.start.z_nm.data();
  const double most_nm = wider * scene.most_off_nm;
  const auto at = std::make_shared<Unknowns>(scene.start);
  const auto value = [&scene, at](const std::vector<double>& z_nm, double* gradient) {
    at->z_nm.data() = z_nm;
    const Objective::State state = scene.objective.evaluate(*at);
    if (gradient) std::ranges::copy(scene.objective.gradient(*at, state).z_nm.data(), gradient);
    return state.value();
  };
  HeightBox box;
  if (spacing == 0) {
    box.heights_nm = [](const std::vector<double>& z) { return z; };
    box.problem.value = [value, n = start.size()](const double* z, double* gradient) {
      return value({z, z + n}, gradient);
    };
    box.problem.start = start;
  } else {
    const auto splines = std::make_shared<Splines>(scene.objective.frame, spacing);
    box.heights_nm = [splines, start](const std::vector<double>& c) {
      return splines->added(start, c.data());
    };
    box.problem.value = [value, splines, start](const double* c, double* gradient) {
      std::vector<double> by_height(gradient ? start.size() : 0);
      const double v = value(splines->added(start, c), gradient ? by_height.data() : nullptr);
      if (gradient) splines->transposed(by_height, gradient);
      return v;
    };
    box.problem.start.assign(splines->numbers(), 0);
  }
  for (const double z : box.problem.start) {
    box.problem.low.push_back(z - most_nm);
    box.problem.high.push_back(z + most_nm);
  }
  return box;
}

}  // namespace surf::bench
