// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "../io_test.h"
#include "surf/io/sem_file.h"
#include "surf/sem/estimate_sem_noise.h"

namespace surf::io {
namespace {

/// The affine law of variance (thesis, 8.2.2) on images of microscopes. What is asserted is in
/// docs/explanation/sem_noise.md: three obey it, two do not, and why.
class RealSemNoise : public test::RealFiles {
 protected:
  SemNoiseEstimate noise_of(const char* name) const {
    return estimate_sem_noise(read_sem_image(root_ / "sem" / name, {.pixel_x_nm = 1}).image);
  }
};

TEST_F(RealSemNoise, HitachiObeysTheLaw) {
  const SemNoiseEstimate e = noise_of("TM_sample_x1200.tif");
  EXPECT_EQ(e.quantum, 1);
  EXPECT_GT(e.p, 1e-3);
  EXPECT_LT(e.bend, 0.1);
  EXPECT_GT(e.noise.slope, 20 * e.slope_stderr());
  EXPECT_LT(std::fabs(e.correlation_x), 0.05);
  EXPECT_EQ(e.off_line_share, 0);
}

TEST_F(RealSemNoise, TescanObeysTheLaw) {
  const SemNoiseEstimate e = noise_of("tescan_example_sem1.tif");
  EXPECT_GT(e.p, 1e-3);
  EXPECT_LT(e.bend, 0.1);
  EXPECT_GT(e.noise.slope, 20 * e.slope_stderr());
}

TEST_F(RealSemNoise, JeolObeysTheLaw) {
  const SemNoiseEstimate e = noise_of("JEOL_etched_sidewall_01.tif");
  EXPECT_GT(e.p, 1e-3);
  EXPECT_LT(e.bend, 0.1);
  EXPECT_LT(std::fabs(e.correlation_x), 0.05);
  EXPECT_LT(e.noise.intercept, 0);  // the line ends above black
}

TEST_F(RealSemNoise, ThermoFisherBends) {
  const SemNoiseEstimate e = noise_of("fei-sem-rbc.tif");
  EXPECT_LT(e.p, 1e-6);
  EXPECT_LT(e.curvature_z, -10);
  EXPECT_GT(e.bend, 0.2);
}

TEST_F(RealSemNoise, ZeissIsFiltered) {
  const SemNoiseEstimate e = noise_of("test_tiff_Zeiss_SEM_512pix.tif");
  EXPECT_GT(e.correlation_x, 0.3);
  EXPECT_GT(e.correlation_y, 0.2);
  EXPECT_GT(e.correlation_sum, 2);
  EXPECT_LT(e.p, 1e-3);
}

}  // namespace
}  // namespace surf::io
