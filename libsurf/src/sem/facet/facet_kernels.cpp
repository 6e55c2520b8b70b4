// SPDX-License-Identifier: GPL-3.0-or-later
#include "facet_kernels.h"

#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf {
namespace {

void check(const FacetScale& scale) {
  if (scale.size < 5 || scale.size > 255 || scale.size % 2 == 0)
    throw InvalidInput("filter bank",
                       fmt::format("a neighbourhood is {} samples across", scale.size),
                       "Give an odd number from 5 to 255");
  if (scale.sigma_px != 0 && !(scale.sigma_px >= 0.3 && scale.sigma_px <= 1000))
    throw InvalidInput("filter bank",
                       fmt::format("a neighbourhood's sigma is {} samples", scale.sigma_px),
                       "Give 0.3 to 1000, or 0 for uniform weights");
}

}  // namespace

FacetKernel facet_kernel(const FacetScale& scale, double pitch_nm) {
  check(scale);
  FacetKernel kernel;
  const int r = kernel.radius = scale.size / 2;
  std::vector<double> weight(r + 1, 1.0);
  if (scale.sigma_px > 0)
    for (int u = 0; u <= r; ++u)
      weight[u] = std::exp(-0.5 * u * u / (scale.sigma_px * scale.sigma_px));

  double m[4] = {};  // moments of even order: of 1, u^2, u^4, u^6
  for (int u = 0; u <= r; ++u) {
    double power = u == 0 ? weight[u] : 2 * weight[u];
    for (double& moment : m) {
      moment += power;
      power *= static_cast<double>(u) * u;
    }
  }
  // Polynomials orthogonal under the weights: 1, u, u^2 - mean, u^3 - ratio u.
  const double mean = m[1] / m[0], ratio = m[2] / m[1];
  double norm2 = 0, norm3 = 0;
  for (int u = 1; u <= r; ++u) {
    const double p2 = u * u - mean, p3 = u * (u * u - ratio);
    norm2 += 2 * weight[u] * p2 * p2;
    norm3 += 2 * weight[u] * p3 * p3;
  }
  norm2 += weight[0] * mean * mean;

  kernel.mix = mean * pitch_nm * pitch_nm;
  for (int u = 0; u <= r; ++u) {
    const double w = weight[u], line = w * u / m[1];
    kernel.e0.push_back(w / m[0]);
    kernel.o1.push_back(line / pitch_nm);
    kernel.e2.push_back(w * (u * u - mean) / norm2 / (pitch_nm * pitch_nm));
    kernel.o3.push_back((line - ratio * w * u * (u * u - ratio) / norm3) / pitch_nm);
  }
  return kernel;
}

}  // namespace surf
