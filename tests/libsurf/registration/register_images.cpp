// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/registration/register_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "made_images.h"
#include "registration/correlation.h"
#include "registration/mutual_information.h"
#include "registration/repeats.h"
#include "registration/verdict.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

using test::error_px;
using test::image_of;
using test::lattice_of;
using test::Scene;
using test::Spots;

Affine random_map(std::uint64_t seed) {
  RandomStream random(seed, 5, 5);
  const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  return make_affine({between(-3.1, 3.1), between(0.8, 1.25), between(0.8, 1.25),
                      between(-0.05, 0.05), between(-12, 12), between(-12, 12)});
}

/// Whether a place of the SEM image lies in an image of `half` nm about the middle, and where.
struct Overlap {
  int w, h;
  double half;
  template <class See>
  void each(const Affine& truth, const See& see) const {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const Point2 p{x - 0.5 * (w - 1), y - 0.5 * (h - 1)}, q = truth(p);
        if (std::abs(q.x) <= half && std::abs(q.y) <= half) see(p, q);
      }
  }
};

/// Cramer and Rao's bound of the error's mean square over the overlap, for the six numbers of the
/// map beside an unknown gain and offset: what white noise in the SEM's image allows at best.
double least_square_error_px2(const Scene& scene, const Affine& truth, const Overlap& overlap,
                              double noise) {
  constexpr std::size_t n = 8;
  constexpr double d = 0.01, unit = 40;  // nm of either, so that all six numbers have one size
  std::array<std::array<double, 2 * n>, n> m{};
  std::array<std::array<double, 3>, 3> moments{};
  double count = 0;
  overlap.each(truth, [&](Point2 p, Point2 q) {
    const double gx = (scene(q.x + d, q.y) - scene(q.x - d, q.y)) / (2 * d);
    const double gy = (scene(q.x, q.y + d) - scene(q.x, q.y - d)) / (2 * d);
    const double u[] = {1, p.x / unit, p.y / unit};
    const double row[n] = {gx * u[0], gx * u[1], gx * u[2],       gy * u[0],
                           gy * u[1], gy * u[2], scene(q.x, q.y), 1};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) m[i][j] += row[i] * row[j] / (noise * noise);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) moments[i][j] += u[i] * u[j];
    count += 1;
  });
  // Gauss and Jordan's inverse, beside the matrix: it is positive definite.
  for (std::size_t i = 0; i < n; ++i) m[i][n + i] = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double pivot = m[i][i];
    for (double& v : m[i]) v /= pivot;
    for (std::size_t k = 0; k < n; ++k) {
      const double factor = m[k][i];
      for (std::size_t j = 0; k != i && j < 2 * n; ++j) m[k][j] -= factor * m[i][j];
    }
  }
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      sum += moments[i][j] / count * (m[i][n + j] + m[i + 3][n + j + 3]);
  return sum;
}

TEST(RegisterImages, FindsRandomMapsWithoutAStart) {
  constexpr int w = 160, h = 120, afm = 120;
  constexpr double half = 0.5 * (afm - 1) * 1.25;
  double z2 = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Spots spots(seed);
    const Affine truth = random_map(seed);
    const Registration r = register_images(image_of(spots, truth, w, h, 1, 0.3, 2 * seed),
                                           image_of(spots, {}, afm, afm, 1.25, 0.03, 2 * seed + 1));
    const double error = error_px(truth, r.sem_to_afm, w, h, half);
    EXPECT_EQ(r.verdict, RegistrationVerdict::verified) << seed << ": " << r.reason;
    EXPECT_LT(error, 0.3) << seed;
    int inside = 0;
    Overlap{w, h, half}.each(truth, [&](Point2, Point2) { ++inside; });
    EXPECT_NEAR(r.overlap, double(inside) / (w * h), 0.02) << seed;
    z2 += error * error / (r.stderr_px * r.stderr_px) / 8;
  }
  // The standard error is not too small, nor far too large.
  EXPECT_GT(z2, 0.1);
  EXPECT_LT(z2, 2);
}

TEST(RegisterImages, FindsSmallNoisyImagesAsWellAsTheirNoiseAllows) {
  // Here the noise alone is worth 0.19 to 0.44 pixels.
  double squares = 0, least = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Spots spots(seed);
    const Affine truth = random_map(seed);
    const Registration r = register_images(image_of(spots, truth, 90, 70, 1, 0.3, 2 * seed),
                                           image_of(spots, {}, 70, 70, 1.25, 0.03, 2 * seed + 1));
    const double error = error_px(truth, r.sem_to_afm, 90, 70, 43);
    EXPECT_LT(error, 1) << seed << ": " << r.reason;
    if (r.verdict != RegistrationVerdict::verified) continue;
    EXPECT_LT(error, 3 * r.stderr_px) << seed;
    squares += error * error;
    least += least_square_error_px2(spots, truth, {90, 70, 43}, 0.3);
  }
  EXPECT_GT(least, 10 * 0.2 * 0.2);  // of ten maps and more
  EXPECT_LT(squares, 1.6 * least);
}

TEST(RegisterImages, MutualInformationFindsInvertedImages) {
  const Spots spots(3);
  const Affine truth = make_affine({0.4, 1.1, 0.95, 0.02, 4, -3});
  const PlacedImage sem = image_of([&](double x, double y) { return -std::tanh(spots(x, y)); },
                                   truth, 90, 70, 1, 0.1, 1);
  const PlacedImage afm = image_of(spots, {}, 90, 90, 1, 0.02, 2);
  for (const EntropyEstimate estimate : {EntropyEstimate::histogram, EntropyEstimate::parzen}) {
    RegistrationOptions options;
    options.objective = RegistrationObjective::mutual_information;
    options.start = make_affine({0.42, 1.08, 0.97, 0.01, 3, -2});
    options.mutual_information.estimate = estimate;
    const Registration r = register_images(sem, afm, options);
    EXPECT_LT(error_px(truth, r.sem_to_afm, 90, 70, 43), 0.5) << r.reason;
    EXPECT_GT(r.score, 0.2);
  }
}

TEST(RegisterImages, BeginsAtAStartThatIsGivenAndLooksPastHoles) {
  const Spots spots(4);
  const Affine truth = make_affine({2, 0.9, 1.05, -0.03, 3, 5});
  PlacedImage sem = image_of(spots, truth, 90, 70, 1, 0.1, 1),
              afm = image_of(spots, {}, 90, 90, 1, 0.02, 2);
  sem.valid = Mask(90, 70, 1);
  for (int y = 20; y < 35; ++y)
    for (int x = 10; x < 40; ++x)
      sem.valid(x, y) = 0, sem.values(x, y) = std::numeric_limits<double>::quiet_NaN();
  afm.valid = Mask(90, 90, 1);
  for (int y = 50; y < 75; ++y)
    for (int x = 20; x < 50; ++x)
      afm.valid(x, y) = 0, afm.values(x, y) = std::numeric_limits<double>::quiet_NaN();
  RegistrationOptions options;
  options.start = make_affine({2.03, 0.93, 1.03, -0.03, 1, 7});
  const Registration r = register_images(sem, afm, options);
  EXPECT_EQ(r.verdict, RegistrationVerdict::verified) << r.reason;
  EXPECT_LT(error_px(truth, r.sem_to_afm, 90, 70, 43), 0.3);
  EXPECT_EQ(r.steps.size(), options.blurs_px.size());
  // Of the SEM's valid pixels those that lie on the AFM's.
  int inside = 0;
  Overlap{90, 70, 44.5}.each(truth, [&](Point2 p, Point2 q) {
    inside += sem.is_valid(static_cast<int>(p.x + 44.5), static_cast<int>(p.y + 34.5)) &&
              !(q.x > 19 - 44.5 && q.x < 50 - 44.5 && q.y > 49 - 44.5 && q.y < 75 - 44.5);
  });
  EXPECT_NEAR(r.overlap, inside / (90.0 * 70 - 15 * 30), 0.01);
}

TEST(RegisterImages, IsAmbiguousWhereTheSceneRepeatsOrSlides) {
  const Scene grating = [](double x, double) { return std::cos(x / 3); };
  const Scene dots = [](double x, double y) {
    return std::pow(std::cos(x / 5) * std::cos(y / 5), 2);
  };
  const Scene line = [](double x, double) { return std::exp(-x * x / 50); };
  for (const Scene& scene : {grating, dots, line}) {
    const Registration r =
        register_images(image_of(scene, make_affine({0.3, 1, 1, 0, 2, 3}), 80, 70, 1, 0.1, 1),
                        image_of(scene, {}, 80, 80, 1, 0.05, 2));
    EXPECT_NE(r.verdict, RegistrationVerdict::verified) << r.reason;
    EXPECT_NE(r.verdict, RegistrationVerdict::unrelated) << r.reason;
  }
}

TEST(RegisterImages, AFineGratingIsAmbiguousAndHasItsRivals) {
  const Scene fine = [](double x, double) { return std::cos(2 * std::numbers::pi * x / 8); };
  const Affine map = make_affine({0.3, 1, 1, 0, 2, 3});
  const PlacedImage sem = image_of(fine, map, 240, 100, 1, 0.1, 1),
                    afm = image_of(fine, {}, 150, 150, 1, 0.05, 2);
  RegistrationOptions
      narrow;  // nothing holds lengths along the lines: every place leaves these limits
  narrow.least_scale = 0.995, narrow.largest_scale = 1.005, narrow.largest_shear = 0;
  for (const RegistrationOptions& options : {RegistrationOptions{}, narrow}) {
    const Registration r = register_images(sem, afm, options);
    EXPECT_EQ(r.verdict, RegistrationVerdict::ambiguous) << r.reason;
    EXPECT_GT(r.score, 0.3);
    EXPECT_GT(r.stderr_px, 0.2);
    EXPECT_FALSE(r.rivals.empty());
  }
}

TEST(RegisterImages, FindsTheRivalsOfALatticeTooFineForTheSearch) {
  // What is broad finds the place and the search has no other; sharp images show mostly what
  // repeats.
  constexpr double period = 12;
  const Scene dots = lattice_of(period);
  const Affine truth = make_affine({0.7, 1.05, 0.95, 0.02, 20, -15});
  for (const std::uint64_t seed : {5, 6}) {
    const Spots spots(seed);
    const Scene scene = [&](double x, double y) { return dots(x, y) + 0.4 * spots(x / 5, y / 5); };
    const PlacedImage sem = image_of(scene, truth, 300, 180, 1, 0.7, 1),
                      afm = image_of(scene, {}, 185, 185, 1.25, 0.03, 2);
    const Registration r = register_images(sem, afm);
    EXPECT_EQ(r.verdict, RegistrationVerdict::ambiguous) << r.reason;
    EXPECT_FALSE(r.rivals.empty());
    for (const RegistrationRival& rival : r.rivals) {
      const Point2 here = r.sem_to_afm({0, 0}), there = rival.sem_to_afm({0, 0});
      EXPECT_NEAR(std::remainder(there.x - here.x, period), 0, 1);
      EXPECT_NEAR(std::remainder(there.y - here.y, period), 0, 1);
      EXPECT_GT(rival.distance_px, 0.8 * period);
    }
    // Landmarks say which, with blurs that leave the pattern there.
    RegistrationOptions options;
    options.blurs_px = {3, 2, 1, 0};
    options.start = make_affine({0.705, 1.05, 0.945, 0.02, 21, -16});
    const Registration led = register_images(sem, afm, options);
    EXPECT_EQ(led.verdict, RegistrationVerdict::verified) << led.reason;
    EXPECT_LT(error_px(truth, led.sem_to_afm, 300, 180, 115), 0.3);
  }
}

TEST(RegisterImages, SaysThatLandmarksOnALatticeMustBeRightToHalfAPeriod) {
  // Led to the next dot it cannot know better, as landmarks say which place is meant.
  const Spots spots(5);
  const Scene dots = lattice_of(12);
  const Affine truth = make_affine({0.3, 1, 1, 0, 4, -3});
  RegistrationOptions options;
  options.blurs_px = {3, 2, 1, 0};
  options.start = compose(Affine{1, 0, 12, 0, 1, 0}, truth);
  const auto reason_of = [&](const Scene& scene) {
    const Registration r = register_images(image_of(scene, truth, 100, 80, 1, 0.3, 1),
                                           image_of(scene, {}, 110, 110, 1, 0.03, 2), options);
    EXPECT_EQ(r.verdict, RegistrationVerdict::verified) << r.reason;
    return r.reason;
  };
  EXPECT_NE(reason_of(dots).find("repeats 1"), std::string::npos);
  options.start = truth;
  EXPECT_EQ(reason_of(spots).find("repeats"), std::string::npos);
}

TEST(RegisterImages, DoesNotAcceptAStartThatIsTooFarOff) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Spots spots(seed);
    const Affine truth = random_map(seed);
    const PlacedImage sem = image_of(spots, truth, 120, 90, 1, 0.3, 1),
                      afm = image_of(spots, {}, 120, 120, 1, 0.03, 2);
    RegistrationOptions options;
    for (const Affine& off : {Affine{1, 0, 50, 0, 1, 0}, make_affine({1.5, 1, 1, 0, 0, 0})}) {
      options.start = compose(truth, off);
      const Registration r = register_images(sem, afm, options);
      EXPECT_NE(r.verdict, RegistrationVerdict::verified) << r.reason;
    }
  }
}

TEST(RegisterImages, AsksForTheOverlapThatIsWanted) {
  // A quarter in common: found when that is allowed.
  const Spots spots(2);
  const Affine truth{1, 0, 90, 0, 1, 0};
  const PlacedImage sem = image_of(spots, truth, 120, 100, 1, 0.3, 1),
                    afm = image_of(spots, {}, 120, 100, 1, 0.03, 2);
  RegistrationOptions options;
  options.least_scale = 0.95, options.largest_scale = 1.05, options.largest_shear = 0.02;
  EXPECT_NE(register_images(sem, afm, options).verdict, RegistrationVerdict::verified);
  options.least_overlap = 0.1;
  const Registration r = register_images(sem, afm, options);
  EXPECT_EQ(r.verdict, RegistrationVerdict::verified) << r.reason;
  EXPECT_NEAR(r.overlap, 0.25, 0.02);
}

TEST(Repeats, AreOtherPlacesOfALatticeAndNoneOfSpots) {
  const Affine map = make_affine({0.3, 1.1, 0.9, 0.03, 7, -4});
  const auto repeats_in = [&](const Scene& scene, ThreePointMap& best) {
    const PlacedImage sem = image_of(scene, map, 90, 70, 1, 0.3, 1),
                      afm = image_of(scene, {}, 80, 70, 1.25, 0.03, 2);
    const ThreePointFrame frame(sem, afm);
    best = frame.three_points(map);
    return repeats_of({sem, afm, frame, 2}, best, 4);
  };
  ThreePointMap best;
  const std::vector<ThreePointMap> repeats = repeats_in(lattice_of(14), best);
  ASSERT_EQ(repeats.size(), 4U);
  for (const ThreePointMap& c : repeats) {
    const double x = c[0] - best[0], y = c[1] - best[1];
    EXPECT_GT(std::hypot(x, y), 13);
    EXPECT_LT(std::hypot(x, y), 45);
    EXPECT_NEAR(std::remainder(x, 14), 0, 0.6);
    EXPECT_NEAR(std::remainder(y, 14), 0, 0.6);
    for (std::size_t i = 2; i < 6; i += 2) {
      EXPECT_NEAR(c[i] - best[i], x, 1e-9);
      EXPECT_NEAR(c[i + 1] - best[i + 1], y, 1e-9);
    }
  }
  EXPECT_TRUE(repeats_in(Spots(3), best).empty());
}

TEST(RegisterImages, DoesNotAcceptAScaleBeyondItsLimits) {
  const Spots spots(5);
  RegistrationOptions options;
  options.least_scale = 0.9, options.largest_scale = 1;
  const Affine larger = make_affine({0.3, 1.1, 1.1, 0, 2, 3});
  const Registration r = register_images(image_of(spots, larger, 90, 70, 1, 0.1, 1),
                                         image_of(spots, {}, 90, 90, 1.25, 0.03, 2), options);
  EXPECT_NE(r.verdict, RegistrationVerdict::verified) << r.reason;
}

TEST(RegisterImages, DoesNotAcceptImagesOfDifferentPlaces) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Registration r = register_images(image_of(Spots(seed), {}, 80, 70, 1, 0.3, 1),
                                           image_of(Spots(seed + 50), {}, 80, 80, 1, 0.03, 2));
    EXPECT_EQ(r.verdict, RegistrationVerdict::unrelated) << r.reason;
  }
  RegistrationOptions options;
  options.start = Affine{1, 0, 1e5, 0, 1, 0};
  const Registration apart = register_images(image_of(Spots(1), {}, 80, 70, 1, 0.3, 1),
                                             image_of(Spots(1), {}, 80, 80, 1, 0.03, 2), options);
  EXPECT_EQ(apart.verdict, RegistrationVerdict::unrelated);
}

TEST(RegisterImages, GivesTheSameForAnyThreadCount) {
  const Spots spots(6);
  const PlacedImage sem = image_of(spots, random_map(6), 70, 60, 1, 0.3, 1),
                    afm = image_of(spots, {}, 70, 70, 1, 0.03, 2);
  RegistrationOptions one, three;
  one.threads = 1, three.threads = 3;
  const Registration a = register_images(sem, afm, one), b = register_images(sem, afm, three);
  EXPECT_EQ(a.sem_to_afm, b.sem_to_afm);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.reason, b.reason);
}

TEST(RegisterImages, RefusesWhatItCannotUse) {
  const Spots spots(7);
  const PlacedImage good = image_of(spots, {}, 40, 40, 1, 0.1, 1);
  PlacedImage flat = good, holed = good, broken = good;
  flat.values = Grid<double>(40, 40, 7);
  holed.valid = Mask(40, 40, 0);
  broken.values(3, 3) = std::numeric_limits<double>::quiet_NaN();
  for (const PlacedImage& bad : {flat, holed, broken}) {
    EXPECT_THROW(register_images(bad, good), InvalidInput);
    EXPECT_THROW(register_images(good, bad), InvalidInput);
  }
  RegistrationOptions options;
  options.blurs_px = {};
  EXPECT_THROW(register_images(good, good, options), UsageError);
  options.blurs_px = {-1};
  EXPECT_THROW(register_images(good, good, options), UsageError);
  options = {};
  options.least_overlap = 0;
  EXPECT_THROW(register_images(good, good, options), UsageError);
  options = {};
  options.start = Affine{1, 1, 0, 1, 1, 0};
  EXPECT_THROW(register_images(good, good, options), UsageError);
}

TEST(RegisterImages, SaturatedAndTinyImagesEndInAVerdict) {
  PlacedImage saturated{{}, Grid<double>(60, 60, 255)};
  saturated.values(30, 30) = 254;
  const PlacedImage other = image_of(Spots(8), {}, 60, 60, 1, 0.1, 1),
                    tiny = image_of(Spots(8), {}, 3, 2, 1, 0.1, 1);
  for (const PlacedImage& bad : {saturated, tiny}) {
    const Registration r = register_images(bad, other), s = register_images(other, bad);
    EXPECT_NE(r.verdict, RegistrationVerdict::verified);
    EXPECT_NE(s.verdict, RegistrationVerdict::verified);
    EXPECT_FALSE(r.reason.empty());
    for (const double v : r.covariance) EXPECT_TRUE(std::isfinite(v));
  }
}

TEST(RegisterImages, IsInterrupted) {
  CancelToken cancel;
  RegistrationOptions options;
  options.watch.cancel = &cancel;
  options.watch.progress = [&](double, double) { cancel.cancel(); };
  const PlacedImage image = image_of(Spots(9), {}, 40, 40, 1, 0.1, 1);
  EXPECT_THROW(register_images(image, image, options), Interrupted);
}

TEST(Verdict, SaysWhatIsAmissBeforeItAccepts) {
  using enum RegistrationVerdict;
  Evidence good;
  good.searched = true;
  good.coarse_evidence = good.best_coarse_evidence = 100;
  good.chance_evidence = 50;
  good.loosest_px = 0.2;
  good.largest_stderr_px = 0.4;
  const auto verdict_of = [](const Evidence& evidence, std::size_t rivals = 0,
                             double stderr_px = 0.1) {
    Registration r;
    r.stderr_px = stderr_px;
    r.rivals.resize(rivals);
    judge(r, evidence);
    EXPECT_FALSE(r.reason.empty());
    EXPECT_EQ(r.slides, evidence.slid_off || evidence.loosest_px > 1);
    return r.verdict;
  };
  EXPECT_EQ(verdict_of(good), verified);
  EXPECT_EQ(verdict_of(good, 1), ambiguous);
  EXPECT_EQ(verdict_of(good, 0, 0.5), ambiguous);
  Evidence bad = good;
  bad.any_place = false;
  EXPECT_EQ(verdict_of(bad), unrelated);
  bad = good, bad.related = false;
  EXPECT_EQ(verdict_of(bad), unrelated);
  bad = good, bad.slid_off = true;
  EXPECT_EQ(verdict_of(bad), ambiguous);
  bad = good, bad.loosest_px = 1.1;
  EXPECT_EQ(verdict_of(bad), ambiguous);
  bad = good,
  bad.coarse_evidence = 40;  // another place agreed while all was coarse, this one did not
  EXPECT_EQ(verdict_of(bad), ambiguous);
  bad = good, bad.settled = false;
  EXPECT_EQ(verdict_of(bad), unconverged);
  bad = good, bad.within_limits = false;
  EXPECT_EQ(verdict_of(bad), unconverged);
  bad = good, bad.searched = false, bad.score = 0.5, bad.score_error = 0.1;
  EXPECT_EQ(verdict_of(bad), unrelated);
  bad.score_error = 0.05;
  EXPECT_EQ(verdict_of(bad), verified);
}

TEST(Verdict, ChanceIsExceededOnceInSoManySearches) {
  // The best of 500 values that follow Gumbel's law: in one of 20 searches it is above the bound of
  // that odds.
  constexpr int searches = 2000, poses = 500;
  int above = 0;
  for (int search = 0; search < searches; ++search) {
    RandomStream random(12, static_cast<std::uint64_t>(search), 1);
    std::vector<double> best;
    for (int i = 0; i < poses; ++i) best.push_back(70 - 9 * std::log(-std::log(random.uniform())));
    std::sort(best.begin(), best.end());
    above += best.back() > chance_bound(best, 20);
  }
  // 100 by the law, give or take four and a half standard deviations.
  EXPECT_NEAR(above, 0.05 * searches, 45);
}

TEST(Correlation, DerivativesAreThoseOfDifferences) {
  const Spots spots(2);
  const PlacedImage sem = image_of(spots, {}, 40, 30, 1, 0.1, 1),
                    afm = image_of(spots, {}, 40, 40, 1.3, 0.1, 2);
  const ThreePointFrame frame(sem, afm);
  const BlurLevel level(sem, afm, frame, 1);
  ThreePointMap c = frame.three_points(make_affine({0.1, 1.02, 0.97, 0.01, 1.3, -0.4}));
  const Correlation correlation(level, c);
  const std::size_t n = correlation.size();
  std::vector<double> r(n), jacobian(6 * n), above(n), below(n);
  ASSERT_GT(correlation.evaluate(c.data(), r.data(), jacobian.data()), 0.1);
  constexpr double step = 1e-5;
  for (std::size_t p = 0; p < 6; ++p) {
    ThreePointMap up = c, down = c;
    up[p] += step, down[p] -= step;
    correlation.evaluate(up.data(), above.data(), nullptr);
    correlation.evaluate(down.data(), below.data(), nullptr);
    for (std::size_t k = 0; k < n; k += 7)
      EXPECT_NEAR(jacobian[p * n + k], (above[k] - below[k]) / (2 * step), 1e-7);
  }
}

TEST(MutualInformation, IsThatOfTheTable) {
  // Two values of either, independent, then the same: 0 and log 2.
  const std::vector<double> a = {0, 0, 1, 1}, b = {0, 1, 0, 1};
  MutualInformationOptions options;
  options.bins = BinRule::deviation;
  JointHistogram apart(a, b, options), same(a, a, options);
  for (std::size_t i = 0; i < 4; ++i) {
    apart.add(apart.bin_a(a[i]), apart.bin_b(b[i]), 1);
    same.add(same.bin_a(a[i]), same.bin_b(a[i]), 1);
  }
  EXPECT_NEAR(apart.information(), 0, 1e-12);
  EXPECT_NEAR(same.information(), std::log(2), 1e-12);
}

TEST(MutualInformation, BinsFollowTheirRules) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(i);
  EXPECT_NEAR(bin_width(values, BinRule::interquartile), 2 * 500 / std::cbrt(1001), 1e-9);
  EXPECT_NEAR(bin_width(values, BinRule::deviation),
              3.49 * std::sqrt(1001.0 * 1001 / 12) / std::cbrt(1001), 0.01);
  EXPECT_EQ(bin_width({3, 3, 3}, BinRule::interquartile), 0);
}

}  // namespace
}  // namespace surf
