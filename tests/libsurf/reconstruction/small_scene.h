// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/random.h"
#include "surf/reconstruction/reconstruct.h"
#include "surf/sem/slope_model.h"

namespace surf::test {

inline ReconstructionOptions quick() {
  ReconstructionOptions o;
  o.uncertainty = false;
  return o;
}

/// A rounded block beside a dimple, 100 nm high: the surface of every place, nm.
inline double small_height(Point2 p) {
  const auto edge = [](double d) { return 0.5 * (1 + std::erf(d / 28)); };
  const double block =
      edge(p.x + 150) * edge(60 - p.x) * edge(p.y + 110) * edge(90 - p.y + 0.3 * p.x);
  const double dimple =
      std::exp(-((p.x - 170) * (p.x - 170) + (p.y + 40) * (p.y + 40)) / (2 * 45 * 45));
  return 80 * block - 25 * dimple;
}

/// Ground that bends everywhere.
inline double rough_height(Point2 p) {
  return 12 * std::sin(0.031 * p.x + 0.3 + std::sin(0.011 * p.y)) +
         12 * std::sin(0.027 * p.y + 0.9 * std::sin(0.013 * p.x)) +
         4 * std::sin(0.061 * (p.x - p.y));
}

/// Both images of such a surface, an SEM image by a model of the slope, with noise of their kinds.
struct SmallScene {
  AfmData afm;
  SemData sem;
  HeightField truth;  ///< on the SEM's pixels

  explicit SmallScene(std::uint64_t seed = 5, int width = 56, int height = 40, double noise = 1,
                      const std::function<double(Point2)>& height_nm = small_height) {
    const double pitch = 10;
    truth = {{pitch, pitch, -0.5 * (width - 1) * pitch, -0.5 * (height - 1) * pitch},
             Grid<double>(width, height)};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) truth.z_nm(x, y) = height_nm({truth.x_nm(x), truth.y_nm(y)});

    SlopeModelParameters p;
    SlopeChannel channel;
    channel.name = "SE";
    p.channels = {channel};
    sem.model = make_slope_model({}, p);
    sem.gains = {100};
    sem.offset = 20;
    sem.noise = {0.05, 1, 0.1};
    sem.sem_to_afm = make_affine({0.3, 1.04, 0.97, 0.02, 15, -8});
    const ModelImages made = sem.model->predict(truth);
    sem.image = {{pitch, pitch, truth.origin_x_nm, truth.origin_y_nm}, made[0]};
    RandomStream random(seed, 1, 0);
    for (double& v : sem.image.values.data()) {
      v = 100 * v + 20;
      v += noise * std::sqrt(sem.noise.variance(v)) * std::sqrt(-2 * std::log(random.uniform())) *
           std::cos(6.283185307179586 * random.uniform());
    }

    // The scan, on three samples per pitch, larger than the SEM image.
    const double afm_pitch = 20;
    const int n = 44, m = 38, f = 3;
    HeightField fine{
        {afm_pitch / f, afm_pitch / f, -0.5 * (n - 1) * afm_pitch, -0.5 * (m - 1) * afm_pitch},
        Grid<double>((n - 1) * f + 1, (m - 1) * f + 1)};
    const Affine back = inverse(sem.sem_to_afm);
    for (int y = 0; y < fine.z_nm.height(); ++y)
      for (int x = 0; x < fine.z_nm.width(); ++x)
        fine.z_nm(x, y) = height_nm(back({fine.x_nm(x), fine.y_nm(y)}));
    const Tip blunt = parabolic_tip(80, {afm_pitch / f, afm_pitch / f, 31, 31});
    const HeightField image = dilate(fine, blunt);
    afm.image = {{afm_pitch, afm_pitch, fine.origin_x_nm, fine.origin_y_nm}, Grid<double>(n, m)};
    afm.noise = {0.825, 0.201};
    const Grid<double> e = simulate_noise(afm.noise, n, m, seed);
    for (int y = 0; y < m; ++y)
      for (int x = 0; x < n; ++x) afm.image.z_nm(x, y) = image.z_nm(f * x, f * y) + noise * e(x, y);
    afm.tip = parabolic_tip(80, {afm_pitch, afm_pitch, 11, 11});
    afm.upsample = f;
  }

  double rms_error(const HeightField& surface) const {
    double sum = 0;
    for (std::size_t i = 0; i < truth.z_nm.size(); ++i) {
      const double d = surface.z_nm.data()[i] - truth.z_nm.data()[i];
      sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(truth.z_nm.size()));
  }
};

}  // namespace surf::test
