// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction/objective.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "afm/normal_numbers.h"
#include "reconstruction/gaussian_basis.h"
#include "reconstruction/image_guides.h"
#include "reconstruction/initial_surface.h"
#include "reconstruction/posterior.h"
#include "reconstruction/preconditioner.h"
#include "small_scene.h"
#include "surf/core/random.h"

namespace surf::reconstruction {
namespace {

enum class Images { both, afm, sem };

Objective make_objective(const test::SmallScene& scene, Images which) {
  const bool with_afm = which != Images::sem, with_sem = which != Images::afm;
  Objective o{.prior = CurvaturePrior(10, 2e-3), .frame = frame_of(&scene.afm, &scene.sem, 4)};
  o.fit_map = with_afm && with_sem;
  o.fit_mixture = with_sem;
  if (with_afm) o.afm.emplace(scene.afm, eroded(scene.afm, 1), o.frame, scene.sem.sem_to_afm, 1);
  if (with_sem) o.sem.emplace(scene.sem, o.frame, 4, 4, 1);
  if (!with_afm) {
    o.anchor_per_nm2 = 1e-3;
    o.start = Grid<double>(o.frame.width, o.frame.height, 7);
  }
  o.fit_tip = with_afm;
  o.fit_blur = with_sem;
  o.fit_film = o.sem && o.sem->has_film();
  o.fit_drift = o.fit_map;
  return o;
}

const FilmEffect some_film{"C", {{0.2, -0.5, 0.1}}};

Unknowns start_at(const test::SmallScene& scene, const Objective& o) {
  Unknowns at{
      on_frame(eroded(scene.afm, 1), o.frame, scene.sem.sem_to_afm), scene.sem.sem_to_afm, {}};
  if (o.sem) at.mixture = {{90}, 25, 0.2, 0.7};
  if (o.fit_tip) at.tip = {0.2, -0.1, 0.15, 0.05, -0.2, 0.1, 0.3};
  // An eroded scan touches the tip in several places at once, where there is no derivative.
  RandomStream random(31, 0, 0);
  for (double& z : at.z_nm.data()) z += random.uniform();
  return at;
}

Step random_step(const Objective& o, std::uint64_t seed, double heights = 1) {
  RandomStream random(seed, 3, 0);
  Step s = o.zero();
  for (double& v : s.z_nm.data()) v = heights * (2 * random.uniform() - 1);
  if (o.fit_map)
    for (double& v : s.map) v = 2 * random.uniform() - 1;
  if (o.fit_mixture)
    for (double& v : s.mixture) v = 2 * random.uniform() - 1;
  if (o.fit_tip)
    for (double& v : s.tip) v = heights * (2 * random.uniform() - 1);
  return s;
}

/// The derivative along a direction against central differences. Contacts that move within the step
/// bend the objective, so the step is small; they are found in single precision, so that it must
/// not be too small.
void expect_gradient(const Objective& o, const Unknowns& at, const Step& direction,
                     double tolerance) {
  const Step g = o.gradient(at, o.evaluate(at));
  const double step = o.afm ? 3e-4 : 3e-3;
  Step up = o.zero(), down = o.zero();
  add(up, step, direction);
  add(down, -step, direction);
  const double difference =
      (o.evaluate(o.moved(at, up)).value() - o.evaluate(o.moved(at, down)).value()) / (2 * step);
  EXPECT_NEAR(dot(g, direction), difference, tolerance * (std::fabs(difference) + 1));
}

TEST(Objective, GradientIsThatOfCentralDifferencesWithEachImageAndBoth) {
  const test::SmallScene scene;
  for (const Images which : {Images::both, Images::afm, Images::sem}) {
    const Objective o = make_objective(scene, which);
    const Unknowns at = start_at(scene, o);
    for (const std::uint64_t seed : {1, 2, 3}) expect_gradient(o, at, random_step(o, seed), 5e-3);
  }
}

TEST(Objective, GradientHoldsWithADiscrepancy) {
  test::SmallScene scene;
  scene.sem.film = some_film;
  scene.sem.discrepancy = usual_discrepancy(scene.sem.image, 0.3);

  Objective o = make_objective(scene, Images::sem);
  const Unknowns at = start_at(scene, o);
  const double without = o.evaluate(at).sem_value;
  o.sem->follow(
      image_guides(at.z_nm, o.frame.pitch_nm, o.evaluate(at).sem->simulated, o.sem->used(), 1), 20);
  EXPECT_LT(o.evaluate(at).sem_value, without);  // it may explain more
  for (const std::uint64_t seed : {1, 2, 3}) expect_gradient(o, at, random_step(o, seed), 3e-3);
  for (int k = 0; k < mixture_numbers; ++k) {
    Step s = o.zero();
    s.mixture[k] = 1;
    expect_gradient(o, at, s, 1e-4);
  }
}

TEST(Objective, GradientHoldsForEachNumberOfMapMixtureAndTipAlone) {
  test::SmallScene scene;
  scene.sem.film = some_film;
  const Objective o = make_objective(scene, Images::both);
  const Unknowns at = start_at(scene, o);
  for (int k = 0; k < map_numbers; ++k) {
    Step s = o.zero();
    s.map[k] = 1;
    expect_gradient(o, at, s, 5e-3);
  }
  for (int k = 0; k < mixture_numbers; ++k) {
    Step s = o.zero();
    s.mixture[k] = 1;
    expect_gradient(o, at, s, 1e-5);
  }
  for (int k = 0; k < tip_numbers; ++k) {
    Step s = o.zero();
    s.tip[k] = 1;
    expect_gradient(o, at, s, 5e-3);
  }
}

TEST(Objective, GradientHoldsOnAPlaneWhereAllContactsTie) {
  test::SmallScene scene;
  for (double& z : scene.afm.image.z_nm.data()) z = 3;
  // A flat tip: every one of its samples touches.
  for (double& z : scene.afm.tip.z_nm.data()) z = 0;
  const Objective o = make_objective(scene, Images::both);
  Unknowns at = start_at(scene, o);
  for (double& z : at.z_nm.data()) z = 2;
  Step lift = o.zero();
  for (double& z : lift.z_nm.data()) z = 1;
  expect_gradient(o, at, lift, 1e-4);
  const Step g = o.gradient(at, o.evaluate(at));
  for (const double v : g.z_nm.data()) ASSERT_TRUE(std::isfinite(v));
}

TEST(Objective, ProductIsSymmetricAndThatOfTheJacobians) {
  const test::SmallScene scene;
  for (const Images which : {Images::both, Images::afm, Images::sem}) {
    const Objective o = make_objective(scene, which);
    const Unknowns at = start_at(scene, o);
    const Objective::State s = o.evaluate(at);
    const Step a = random_step(o, 4), b = random_step(o, 5);
    const Step pa = o.product(at, s, a), pb = o.product(at, s, b);
    const double scale = std::sqrt(std::fabs(dot(a, pa) * dot(b, pb)));
    EXPECT_NEAR(dot(a, pb), dot(b, pa), 1e-5 * scale);
    EXPECT_GT(dot(a, pa), 0);
  }
}

TEST(Objective, ProductPredictsTheGradientOfWhatIsQuadratic) {
  // Without SEM, with contacts that stay and the prior's weights held, the objective is quadratic.
  const test::SmallScene scene;
  const Objective o = make_objective(scene, Images::afm);
  const Unknowns at = start_at(scene, o);
  const Objective::State s = o.evaluate(at);
  Step d = random_step(o, 6, 1e-7);
  d.tip = {};  // an exponential, not linear
  const Step p = o.product(at, s, d);
  const Unknowns there = o.moved(at, d);
  Step g = o.gradient(there, o.evaluate(there));
  add(g, -1, o.gradient(at, s));
  // The prior's true second derivative differs from its bound: compare the AFM's part.
  Objective no_prior = o;
  no_prior.prior = CurvaturePrior(10, 1e9);
  Step g2 = no_prior.gradient(there, no_prior.evaluate(there));
  add(g2, -1, no_prior.gradient(at, no_prior.evaluate(at)));
  const Step p2 = no_prior.product(at, no_prior.evaluate(at), d);
  EXPECT_NEAR(dot(g2, g2), dot(p2, p2), 1e-3 * dot(p2, p2));
  EXPECT_LT(dot(d, g), dot(d, p) * 1.001);
}

TEST(Objective, LiftingSurfaceAndScanTogetherChangesNothing) {
  test::SmallScene scene;
  const Objective o = make_objective(scene, Images::both);
  Unknowns at = start_at(scene, o);
  const double before = o.evaluate(at).value();
  for (double& z : scene.afm.image.z_nm.data()) z += 1000;
  const Objective lifted = make_objective(scene, Images::both);
  for (double& z : at.z_nm.data()) z += 1000;
  EXPECT_NEAR(lifted.evaluate(at).value(), before, 1e-6 * before);
}

TEST(Objective, DilationIsThatOfTheLibrary) {
  // Identity map, one sample per pitch, surface on the AFM's samples: the plain dilation.
  test::SmallScene scene;
  scene.afm.upsample = 1;
  const SurfaceFrame frame = frame_of(&scene.afm, nullptr, 0);
  const AfmTerm term(scene.afm, eroded(scene.afm, 1), frame, {}, 1);
  Grid<double> z(frame.width, frame.height);
  RandomStream random(9, 0, 0);
  for (double& v : z.data()) v = 30 * random.uniform();
  HeightField surface = scene.afm.image;
  surface.z_nm = z;
  for (const TipChange& change : {TipChange{}, TipChange{0.3, 0.2, -0.2, 0.1, 0.4, -0.1, 0.2}}) {
    const Grid<double> expected = dilate(surface, term.tip(change)).z_nm,
                       got = term.evaluate(z, {}, change).simulated;
    for (std::size_t i = 0; i < got.size(); ++i)
      ASSERT_NEAR(got.data()[i], expected.data()[i], 1e-5);
  }
  EXPECT_EQ(term.tip({}).z_nm, scene.afm.tip.z_nm);
}

TEST(Preconditioner, SolvesTheMatrixThatItHolds) {
  // With white noise, contacts on samples and no SEM it is the second derivative itself.
  test::SmallScene scene;
  scene.afm.upsample = 1;
  scene.afm.noise = {0, 0.5};
  Objective o{.prior = CurvaturePrior(20, 2e-3), .frame = frame_of(&scene.afm, nullptr, 0)};
  o.afm.emplace(scene.afm, eroded(scene.afm, 1), o.frame, Affine{}, 1);
  const Unknowns at{eroded(scene.afm, 1).z_nm, {}, {}};
  const Objective::State s = o.evaluate(at);
  for (const bool fit_tip : {false, true}) {
    o.fit_tip = fit_tip;
    Preconditioner m(0, 0);
    m.factor(o, at, s);
    const Step v = random_step(o, 8), back = m.solve(o.product(at, s, v));
    for (std::size_t i = 0; i < v.z_nm.size(); ++i)
      ASSERT_NEAR(back.z_nm.data()[i], v.z_nm.data()[i], 1e-5);
    for (int k = 0; k < tip_numbers; ++k) ASSERT_NEAR(back.tip[k], v.tip[k], 1e-5);
  }
}

TEST(Preconditioner, DrawsHaveItsInverseAsCovariance) {
  const test::SmallScene scene(5, 24, 18);
  Objective o = make_objective(scene, Images::both);
  o.fit_tip = false;  // draws hold it
  const Unknowns at = start_at(scene, o);
  Preconditioner m(0, 0);
  m.factor(o, at, o.evaluate(at));
  constexpr int draws = 2000;
  const Grid<double> squares = m.variances(o.prior, draws, 5, {}).height_nm2;
  for (std::size_t i = 0; i < squares.size(); i += 37) {
    Step unit = o.zero();
    unit.z_nm.data()[i] = 1;
    const double expected = m.solve(unit).z_nm.data()[i];
    // The variance of a variance of so many draws; 23 comparisons.
    ASSERT_NEAR(squares.data()[i], expected, 4.6 * std::sqrt(2.0 / draws) * expected) << i;
  }
}

TEST(Preconditioner, TilesAreSymmetricAndDoNotDependOnThreads) {
  const test::SmallScene scene(5, 112, 90);
  const Objective o = make_objective(scene, Images::both);
  const Unknowns at = start_at(scene, o);
  const Objective::State s = o.evaluate(at);
  Preconditioner one(48, 1), three(48, 3), whole(0, 1);
  for (Preconditioner* m : {&one, &three, &whole}) m->factor(o, at, s);
  const Step u = random_step(o, 1), v = random_step(o, 2), mu = one.solve(u), mv = one.solve(v);
  EXPECT_NEAR(dot(u, mv), dot(mu, v), 1e-6 * std::fabs(dot(u, mu)));  // single precision
  EXPECT_GT(dot(u, mu), 0);
  EXPECT_EQ(three.solve(u).z_nm.data(), mu.z_nm.data());
  // Where what it is asked is smooth it answers nearly as the whole matrix does, seams included.
  Step pull = o.zero();
  for (int y = 0; y < o.frame.height; ++y)
    for (int x = 0; x < o.frame.width; ++x) pull.z_nm(x, y) = std::sin(0.3 * x) * std::cos(0.2 * y);
  const Grid<double> tiled = one.solve(pull).z_nm, exact = whole.solve(pull).z_nm;
  double off = 0, all = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    off += std::pow(tiled.data()[i] - exact.data()[i], 2);
    all += std::pow(exact.data()[i], 2);
  }
  EXPECT_LT(off, 0.012 * all);
}

TEST(Preconditioner, SeveralResidualsAreSolvedAsOneByOne) {
  const test::SmallScene scene(5, 112, 90);
  const Objective o = make_objective(scene, Images::both);
  const Unknowns at = start_at(scene, o);
  Preconditioner m(48, 2);
  m.factor(o, at, o.evaluate(at));
  EXPECT_EQ(m.double_tiles(), 0);
  const std::vector<Step> all{random_step(o, 1), random_step(o, 2), random_step(o, 3)};
  const std::vector<Step> solved = m.solve(all);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Step one = m.solve(all[k]);
    EXPECT_EQ(one.z_nm, solved[k].z_nm);
    EXPECT_EQ(one.map, solved[k].map);
    EXPECT_EQ(one.mixture, solved[k].mixture);
    EXPECT_EQ(one.tip, solved[k].tip);
  }
}

TEST(Preconditioner, SinglePrecisionGivesTheVariancesOfDoublePrecision) {
  const test::SmallScene scene;
  const Objective o = make_objective(scene, Images::both);
  const Unknowns at = start_at(scene, o);
  const Objective::State s = o.evaluate(at);
  Preconditioner single(48, 1), three(48, 3), twice(48, 1, Precision::double_always);
  for (Preconditioner* m : {&single, &three, &twice}) m->factor(o, at, s);
  EXPECT_EQ(single.double_tiles(), 0);
  EXPECT_EQ(twice.double_tiles(), twice.tiles());
  EXPECT_LT(single.bytes(), 0.55 * static_cast<double>(twice.bytes()));
  const Grid<double> a = single.variances(o.prior, 15, 5, {}).height_nm2,
                     b = twice.variances(o.prior, 15, 5, {}).height_nm2;
  EXPECT_EQ(three.variances(o.prior, 15, 5, {}).height_nm2, a);
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_NEAR(a.data()[i], b.data()[i], 0.01 * b.data()[i]) << i;
}

TEST(Posterior, DeviationsOfBothPrecisionsAgree) {
  const test::SmallScene scene;
  const Objective o = make_objective(scene, Images::both);
  const Unknowns at = start_at(scene, o);
  const Grid<double> a = posterior(o, at, {}, 6, 1, 1, Precision::single_where_it_holds, {})
                             .deviation_nm,
                     b = posterior(o, at, {}, 6, 1, 1, Precision::double_always, {}).deviation_nm;
  EXPECT_EQ(posterior(o, at, {}, 6, 1, 3, Precision::single_where_it_holds, {}).deviation_nm, a);
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_NEAR(a.data()[i], b.data()[i], 0.01 * b.data()[i]) << i;
}

TEST(Posterior, WhatATipsFitChangesIsADoubtOfHeights) {
  const test::SmallScene scene;
  const Objective o = make_objective(scene, Images::both);
  Unknowns at = start_at(scene, o);
  for (double& t : at.tip) t *= 5;  // by more than noise explains
  const Curvature a = expected_curvature(o, at, 1, 1, Precision::double_always, {});
  const Step by_tip = change_by_tip(o, at, a, {}, {});
  EXPECT_EQ(by_tip.tip, TipChange{});
  // With the tip put back, everything else is at its optimum again.
  Step tip = o.zero();
  tip.tip = at.tip;
  Step whole = by_tip;
  add(whole, -1, tip);
  Step alone = o.product(at, a.state, tip, &a.near), left = o.product(at, a.state, whole, &a.near);
  alone.tip = left.tip = {};
  EXPECT_LT(dot(left, a.preconditioner->solve(left)),
            0.01 * dot(alone, a.preconditioner->solve(alone)));

  const Grid<double> deviation =
      posterior(o, at, {}, 6, 1, 1, Precision::double_always, {}).deviation_nm;
  Grid<double> squares = by_tip.z_nm;
  for (double& v : squares.data()) v *= v;
  squares = GaussianBasis(3, 1).sum(squares);
  for (std::size_t i = 0; i < deviation.size(); ++i)
    ASSERT_GE(1.02 * deviation.data()[i], std::sqrt(squares.data()[i])) << i;
}

TEST(Posterior, ASpotThatIsNotKnownIsADoubtOfHeightsAndNoBias) {
  const test::SmallScene scene;
  Objective o = make_objective(scene, Images::both);
  Unknowns at = start_at(scene, o);
  at.mixture.gains = {2000};  // so that heights are the image's matter
  // What heights a wider spot pulls at.
  Step wider = o.zero();
  wider.mixture[2] = 1;
  std::vector<Step> heights(1, o.zero());
  heights[0].z_nm = o.product(at, o.evaluate(at), wider).z_nm;
  const auto of = [&](bool spot, Step* bias) {
    o.fit_blur = spot;
    const Curvature a = expected_curvature(o, at, 1, 1, Precision::double_always, {});
    *bias = prior_bias(o, at, a, {.spot = true}, {});
    return deviations_of(o, at, a, o.zero(), heights, {});
  };
  Step bias_known, bias_unknown;
  const std::vector<double> known = of(false, &bias_known), unknown = of(true, &bias_unknown);
  EXPECT_GT(unknown[0], 1.1 * known[0]);
  EXPECT_EQ(bias_unknown.mixture[2], 0);
  add(bias_unknown, -1, bias_known);
  EXPECT_LT(dot(bias_unknown, bias_unknown), 0.01 * dot(bias_known, bias_known));
}

TEST(SemTerm, NearDoesToWavesOfTwelveSamplesWhatTheModelDoes) {
  const test::SmallScene scene;
  const Objective o = make_objective(scene, Images::sem);
  const Unknowns at = start_at(scene, o);
  const Objective::State s = o.evaluate(at);
  const SemTerm::Near near = o.sem->near(*s.sem, at.mixture);
  for (const bool along_x : {true, false}) {
    Grid<double> wave(o.frame.width, o.frame.height);
    for (int y = 0; y < wave.height(); ++y)
      for (int x = 0; x < wave.width(); ++x)
        wave(x, y) = std::cos(std::numbers::pi / 6 * (along_x ? x : y) + 0.7);
    const Grid<double> exact = o.sem->change(*s.sem, at.mixture, wave, {}),
                       sparse = o.sem->change(*s.sem, at.mixture, wave, {}, &near);
    double size = 0;
    for (const double v : exact.data()) size = std::max(size, std::fabs(v));
    for (int y = 1; y + 1 < wave.height(); ++y)
      for (int x = 1; x + 1 < wave.width(); ++x)
        ASSERT_NEAR(sparse(x, y), exact(x, y), 1e-6 * size) << x << " " << y;
  }
}

TEST(SemTerm, NearsTransposeIsExact) {
  const test::SmallScene scene;
  const Objective o = make_objective(scene, Images::both);
  const Unknowns at = start_at(scene, o);
  const Objective::State s = o.evaluate(at);
  const SemTerm::Near near = o.sem->near(*s.sem, at.mixture);
  const Step u = random_step(o, 3), v = random_step(o, 4);
  const Grid<double> ju = o.sem->change(*s.sem, at.mixture, u.z_nm, u.mixture, &near);
  Step back = o.zero();
  o.sem->add_gradient(*s.sem, at.mixture, v.z_nm, &near, back.z_nm, &back.mixture);
  double left = 0, right = 0;
  for (std::size_t i = 0; i < ju.size(); ++i) left += v.z_nm.data()[i] * ju.data()[i];
  for (std::size_t i = 0; i < ju.size(); ++i) right += back.z_nm.data()[i] * u.z_nm.data()[i];
  for (std::size_t i = 0; i < u.mixture.size(); ++i) right += back.mixture[i] * u.mixture[i];
  EXPECT_NEAR(left, right, 1e-9 * std::fabs(left));
  const Objective::Near all{near, {}};
  const Step a = o.product(at, s, u, &all), b = o.product(at, s, v, &all);
  EXPECT_NEAR(dot(v, a), dot(u, b), 1e-9 * std::fabs(dot(u, a)));
  EXPECT_GT(dot(u, a), 0);
}

TEST(CurvaturePrior, LikelyCurvatureIsThatOfHalfTheSamples) {
  Grid<double> bowl(60, 50), half = bowl;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x) {
      bowl(x, y) = 0.5 * 3e-3 * 100 * (x - 30) * (x - 30);
      half(x, y) = x < 20 ? bowl(x, y) : bowl(20, y) - 3 * (x - 20);
    }
  const CurvaturePrior prior(10, 1e-3);
  EXPECT_NEAR(prior.likely_curvature_per_nm(bowl), 3e-3,
              1.5e-4);  // rows at the border have no second difference
  EXPECT_LT(prior.likely_curvature_per_nm(half), 1e-8);
  EXPECT_LE(prior.likely_curvature_per_nm(Grid<double>(60, 50)), 2e-9);
}

TEST(GaussianBasis, TransposeIsExactAndConstantsStay) {
  for (const double sigma : {0.39, 2.0, 9.0}) {
    const GaussianBasis basis(sigma, 2);
    Grid<double> a(23, 17), b(23, 17);
    RandomStream random(1, 0, 0);
    for (double& v : a.data()) v = random.uniform();
    for (double& v : b.data()) v = random.uniform();
    const Grid<double> ga = basis.sum(a), gb = basis.transpose(b);
    double left = 0, right = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      left += ga.data()[i] * b.data()[i];
      right += a.data()[i] * gb.data()[i];
    }
    EXPECT_NEAR(left, right, 1e-10 * left);
    const Grid<double> level = basis.sum(Grid<double>(23, 17, 4));
    for (const double v : level.data()) ASSERT_NEAR(v, 4, 1e-12);
  }
}

TEST(GaussianBasis, DeconvolutionGivesBackWhatWasBlurred) {
  const GaussianBasis basis(2, 1);
  Grid<double> z(40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) z(x, y) = 10 * std::sin(0.2 * x) + 5 * std::cos(0.25 * y);
  const Grid<double> blurred = basis.sum(z),
                     again = basis.sum(basis.deconvolved(blurred, 1e-4, 500));
  for (std::size_t i = 0; i < z.size(); ++i) ASSERT_NEAR(again.data()[i], blurred.data()[i], 1e-3);
}

}  // namespace
}  // namespace surf::reconstruction
