// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/tilt_by_sem.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "sem_term.h"
#include "surface_frame.h"

namespace surf {
namespace {

using namespace reconstruction;

constexpr int most_iterations = 6;
constexpr double settled = 0.05;  // of the standard errors

}  // namespace

SemTilt tilt_by_sem(const HeightField& surface, const SemData& sem, const Affine& sem_to_afm,
                    const SemTilt& before, int threads) {
  const SlopeDoubt& doubt = before.doubt;
  SemTilt tilt{0, 0, doubt, 0};
  if (!(doubt.x > 0 && doubt.y > 0)) return tilt;
  const int width = surface.z_nm.width(), height = surface.z_nm.height();
  const SemTerm term(sem,
                     {width, height, surface.pitch_x_nm, surface.origin_x_nm, surface.origin_y_nm},
                     0, 0, threads);
  // Planes of slope 1 along the scan's axes.
  const Point2 middle = sem_to_afm(surface.place_nm(0.5 * (width - 1), 0.5 * (height - 1)));
  std::array<Grid<double>, 2> planes{Grid<double>(width, height), Grid<double>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Point2 p = sem_to_afm(surface.place_nm(x, y));
      planes[0](x, y) = p.x - middle.x;
      planes[1](x, y) = p.y - middle.y;
    }
  Mixture mixture{sem.gains, sem.offset};
  while (tilt.iterations < most_iterations) {
    ++tilt.iterations;
    Grid<double> z = surface.z_nm;
    for (std::size_t i = 0; i < z.size(); ++i)
      z.data()[i] += tilt.x * planes[0].data()[i] + tilt.y * planes[1].data()[i];
    const SemTerm::State state = term.evaluate(z, mixture);
    constexpr int unknowns = 4;
    std::array<Grid<double>, unknowns> columns, weighed;
    const Grid<double> unmoved(width, height);
    for (int k = 0; k < unknowns; ++k) {
      columns[k] = term.change(state, mixture, k < 2 ? planes[k] : unmoved,
                               {k == 2 ? 1.0 : 0.0, k == 3 ? 1.0 : 0.0});
      weighed[k] = term.precision(state, columns[k]);
    }
    Eigen::Matrix4d matrix;
    Eigen::Vector4d gradient;
    for (int k = 0; k < unknowns; ++k) {
      gradient(k) = 0;
      for (std::size_t i = 0; i < z.size(); ++i)
        gradient(k) += state.pull.data()[i] * columns[k].data()[i];
      for (int l = 0; l < unknowns; ++l) {
        matrix(k, l) = 0;
        for (std::size_t i = 0; i < z.size(); ++i)
          matrix(k, l) += weighed[k].data()[i] * columns[l].data()[i];
      }
    }
    matrix(0, 0) += 1 / (doubt.x * doubt.x),
        gradient(0) += (tilt.x - before.x) / (doubt.x * doubt.x);
    matrix(1, 1) += 1 / (doubt.y * doubt.y),
        gradient(1) += (tilt.y - before.y) / (doubt.y * doubt.y);
    const Eigen::Matrix4d covariance = matrix.inverse();
    if (!covariance.allFinite()) break;  // nothing but a constant: gain and offset are one
    const Eigen::Vector4d step = -(covariance * gradient);
    tilt.x += step(0), tilt.y += step(1);
    for (double& gain : mixture.gains) gain *= 1 + step(2);
    mixture.offset += step(3);
    tilt.doubt = {std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1))};
    if (std::abs(step(0)) < settled * tilt.doubt.x && std::abs(step(1)) < settled * tilt.doubt.y)
      break;
  }
  return tilt;
}

}  // namespace surf
