// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/primaries_per_pixel.h"

#include "results/shot_noise.h"

#include "specimens.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf::mc {

TEST(Dose, PrimariesOfPixelsArePoisson) {
  for (const double dose : {0.7, 12.0, 400.0}) {
    const int n = 20000;
    const auto cells = static_cast<std::size_t>(3 * dose + 10);
    std::vector<std::int64_t> counts(cells);
    for (int i = 0; i < n; ++i) {
      const std::int64_t k = primaries_of_pixel(dose, 5, static_cast<std::uint64_t>(i));
      ASSERT_LT(k, static_cast<std::int64_t>(cells));
      ++counts[static_cast<std::size_t>(k)];
    }
    std::vector<double> expected;
    for (std::size_t k = 0; k < cells; ++k)
      expected.push_back(n *
                         std::exp(double(k) * std::log(dose) - dose - std::lgamma(double(k) + 1)));
    test::expect_distributed(counts, expected, 3);
  }
}

TEST(Dose, ADetectorSeesItsShare) {
  test::Sample share;
  for (std::uint64_t p = 0; p < 20000; ++p)
    share.add(static_cast<double>(detected(100, 0.3, 1, p, 2)));
  test::expect_mean(share.mean(), std::sqrt(100 * 0.3 * 0.7 / 20000), 30);
  EXPECT_NEAR(share.standard_error(), std::sqrt(100 * 0.3 * 0.7 / 20000), 0.002);
  EXPECT_EQ(detected(100, 1, 1, 0, 0), 100);
}

// The variance of what a microscope shows is that of a compound Poisson sum: dose times the mean
// square of the electrons per primary.
TEST(Dose, TheImageHasAMicroscopesNoise) {
  SimulationOptions options;
  options.budget = Dose{25};
  const Scan scan = test::square_scan(100, 48);
  const Scene scene(test::flat("Si"), {}, scan);
  const auto r = simulate(scene, options);
  EXPECT_TRUE(r.complete);
  const Image image = make_image(r, scan);
  Counts all;
  for (const Counts& c : r.counts[test::se].data()) all += c;
  const double mean_square =
      static_cast<double>(all.squares) / static_cast<double>(r.balance.incident);
  double squares = 0;
  test::Sample shot;
  const double truth = test::mean_yield(r, test::se).mean;
  for (const float v : image.find("SE.shot")->values.data()) {
    shot.add(v);
    squares += (v - truth) * (v - truth);
  }
  test::expect_mean(shot.mean(), shot.standard_error(), truth, 2);
  const double pixels = static_cast<double>(r.pixels.size());
  // The variance of a sample variance: about 2 / n, more for a skewed distribution.
  EXPECT_NEAR(squares / pixels, mean_square / 25, 5 * std::sqrt(3 / pixels) * mean_square / 25);

  options.threads = 1;
  options.tile_pixels = 7;
  EXPECT_EQ(make_image(simulate(scene, options), scan).find("SE.shot")->values,
            image.find("SE.shot")->values);
}

TEST(Dose, RefusesNonsense) {
  SimulationOptions options;
  options.budget = Dose{2e9};
  const Scan scan = test::square_scan(100, 1);
  EXPECT_THROW(simulate(Scene(test::flat("Si"), {}, scan), options), UsageError);
  options.budget = Dose{std::nan("")};
  EXPECT_THROW(simulate(Scene(test::flat("Si"), {}, scan), options), UsageError);
}

}  // namespace surf::mc
