// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/facet/facet_kernels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sem/facet/facet_pass.h"
#include "sem/model_surfaces.h"
#include "surf/core/error.h"

namespace {

using namespace surf;

std::vector<FacetScale> uniform_scales() {
  std::vector<FacetScale> scales = thesis_scales();
  for (FacetScale& scale : scales) scale.sigma_px = 0;
  return scales;
}

// A field that is one cubic everywhere: the fit far from the border must give it back at every
// pixel.
template <class T>
double worst_recovery(const std::vector<FacetScale>& scales, double pitch_x, double pitch_y) {
  RandomStream random(3, 0, 0);
  double k[11];
  for (double& c : k) c = 2 * random.uniform() - 1;
  // In units that leave all terms alike over the field.
  const double length = 60;
  const int n = 120, margin = 42;
  const auto value = [&](double x, double y) {
    return k[1] + k[2] * y + k[3] * x + k[4] * y * y + k[5] * x * y + k[6] * x * x +
           k[7] * y * y * y + k[8] * y * y * x + k[9] * y * x * x + k[10] * x * x * x;
  };
  HeightField field{{pitch_x, pitch_y}, Grid<double>(n, n)};
  const auto at = [&](int i) { return (i - n / 2) / length; };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) field.z_nm(x, y) = value(at(x), at(y));

  const facet::FacetPass<T> pass(scales, pitch_x, pitch_y);
  typename facet::FacetPass<T>::Scratch scratch;
  double worst = 0;
  for (const facet::Block& block : pass.blocks(n, n)) {
    pass.load(field.z_nm, Edge::mirror, block, scratch);
    for (int s = 0; s < pass.scales(); ++s) {
      const T* fit = pass.fit(s, scratch);
      for (int row = 0; row < block.rows; ++row)
        for (int column = 0; column < block.width; ++column) {
          const int px = block.x + column, py = block.y + row;
          if (px < margin || py < margin || px >= n - margin || py >= n - margin) continue;
          const double x = at(px), y = at(py), ux = length * pitch_x, uy = length * pitch_y;
          const double want[5] = {(k[2] + 2 * k[4] * y + k[5] * x + 3 * k[7] * y * y +
                                   2 * k[8] * y * x + k[9] * x * x) /
                                      uy,
                                  (k[3] + k[5] * y + 2 * k[6] * x + k[8] * y * y +
                                   2 * k[9] * y * x + 3 * k[10] * x * x) /
                                      ux,
                                  (k[4] + 3 * k[7] * y + k[8] * x) / (uy * uy),
                                  (k[5] + 2 * k[8] * y + 2 * k[9] * x) / (ux * uy),
                                  (k[6] + k[9] * y + 3 * k[10] * x) / (ux * ux)};
          const double unit[5] = {uy, ux, uy * uy, ux * uy, ux * ux};
          for (int i = 0; i < 5; ++i) {
            const double got = fit[(row * facet::coefficients + i) * pass.columns() + column];
            worst = std::max(worst, std::abs(got - want[i]) * unit[i]);
          }
        }
    }
  }
  return worst;
}

TEST(FacetKernels, GiveCubicsBackAtEveryNeighbourhood) {
  for (const auto& scales : {thesis_scales(), uniform_scales()}) {
    EXPECT_LT(worst_recovery<double>(scales, 1, 1), 3e-11);
    EXPECT_LT(worst_recovery<double>(scales, 3, 0.7), 3e-11);
    EXPECT_LT(worst_recovery<float>(scales, 1, 1),
              3e-2);  // second derivatives of the smallest, 60^2 times rounding
  }
}

TEST(FacetKernels, OfAConstantAreNothing) {
  for (const FacetScale& scale : thesis_scales()) {
    const FacetKernel k = facet_kernel(scale, 2);
    double mean = k.e0[0], curvature = k.e2[0];
    for (int u = 1; u <= k.radius; ++u) {
      mean += 2 * k.e0[u];
      curvature += 2 * k.e2[u];
    }
    EXPECT_NEAR(mean, 1, 1e-14);
    EXPECT_NEAR(curvature, 0, 1e-14);
  }
}

TEST(FacetKernels, RefuseWhatCannotBeFitted) {
  for (const FacetScale& scale :
       {FacetScale{3, 0.6}, FacetScale{6, 1}, FacetScale{257, 9}, FacetScale{5, 0.1},
        FacetScale{5, -1}, FacetScale{5, std::nan("")}})
    EXPECT_THROW(facet_kernel(scale, 1), InvalidInput);
}

}  // namespace
