// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm/normal_numbers.h"
#include "reconstruction/beam_heights.h"
#include "reconstruction/initial_surface.h"
#include "reconstruction/objective.h"
#include "small_scene.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::reconstruction {
namespace {

const SurfaceFrame ground{60, 44, 10, -300, -220};
const SurfaceFrame seen_on{50, 36, 9, -230, -150};
const ViewPose some_pose{9, 35, {1.01, 0.02, 6, -0.015, 0.99, -4}};

Grid<double> heights(const std::function<double(Point2)>& z) {
  Grid<double> out(ground.width, ground.height);
  for (int y = 0; y < ground.height; ++y)
    for (int x = 0; x < ground.width; ++x)
      out(x, y) = z({ground.origin_x_nm + 10 * x, ground.origin_y_nm + 10 * y});
  return out;
}

double largest(const Grid<double>& g) {
  double most = 0;
  for (const double v : g.data()) most = std::max(most, std::fabs(v));
  return most;
}

/// The height along the beam of what it meets first, by a fine march.
double met(const std::function<double(Point2)>& z, const ViewPose& pose, Point2 in_plane,
           double top_nm) {
  const BeamAxes axes = beam_axes(pose.tilt_deg, pose.azimuth_deg);
  const Vec3 foot = axes.across * in_plane.x + axes.up * in_plane.y;
  double c = (top_nm - foot.z) / axes.against.z;
  for (double step : {0.5, 1e-3, 1e-6}) {
    const auto above = [&](double along) {
      const Vec3 p = foot + axes.against * along;
      return p.z - z({p.x, p.y});
    };
    while (above(c) > 0) c -= step;
    c += step;
  }
  return c;
}

TEST(BeamAxes, AreTheScans) {
  const BeamAxes upright = beam_axes(0, 70);
  EXPECT_EQ(upright.across, (Vec3{1, 0, 0}));
  EXPECT_EQ(upright.up, (Vec3{0, 1, 0}));
  // Toward +x at azimuth 0: the beam travels to +x, so that it sees walls that face -x.
  const BeamAxes to_x = beam_axes(10, 0);
  EXPECT_NEAR(to_x.against.x, -std::sin(10 * degrees_to_radians), 1e-12);
  EXPECT_NEAR(to_x.across.z, std::sin(10 * degrees_to_radians), 1e-12);
  EXPECT_NEAR(to_x.up.y, 1, 1e-12);
  const BeamAxes any = beam_axes(33, 200);
  EXPECT_NEAR(dot(any.across, any.up), 0, 1e-12);
  EXPECT_NEAR(dot(any.across, any.against), 0, 1e-12);
  EXPECT_NEAR(dot(cross(any.across, any.up), any.against), 1, 1e-12);
}

TEST(BeamHeights, AnUprightViewSeesTheHeights) {
  const Grid<double> z = heights(test::small_height);
  const BeamHeights seen(ground, z, {}, ground, 1);
  for (std::size_t i = 0; i < z.size(); ++i)
    EXPECT_NEAR(seen.heights().data()[i], z.data()[i], 1e-8);
}

TEST(BeamHeights, AreOfWhatTheBeamMeetsFirst) {
  const auto bump = [](Point2 p) {
    return 60 * std::exp(-(p.x * p.x + p.y * p.y) / (2 * 50 * 50)) + 0.05 * p.x;
  };
  for (const double tilt : {2.0, 20.0, 55.0}) {  // at 55 degrees the bump hides what is behind it
    const ViewPose pose{tilt, 35, some_pose.to_plane};
    const BeamHeights seen(ground, heights(bump), pose, seen_on, 2);
    for (int y = 6; y < 30; y += 3)
      for (int x = 6; x < 44; x += 3) {
        const Point2 p = pose.to_plane({-230.0 + 9 * x, -150.0 + 9 * y});
        if (std::fabs(seen.hit(x, y).x - 29.5) > 28 || std::fabs(seen.hit(x, y).y - 21.5) > 20)
          continue;
        EXPECT_NEAR(seen.heights()(x, y), met(bump, pose, p, 100), 0.4) << tilt;
      }
  }
}

TEST(BeamHeights, DerivativesAreThoseOfDifferences) {
  const Grid<double> z = heights(test::small_height);
  const BeamHeights seen(ground, z, some_pose, seen_on, 1);
  NormalNumbers normal(3, 1);
  Grid<double> dz(ground.width, ground.height);
  for (double& v : dz.data()) v = normal();
  const double step = 1e-4;
  Grid<double> up = z, down = z;
  for (std::size_t i = 0; i < z.size(); ++i)
    up.data()[i] += step * dz.data()[i], down.data()[i] -= step * dz.data()[i];
  const Grid<double> change = seen.change(dz),
                     above = BeamHeights(ground, up, some_pose, seen_on, 1).heights(),
                     below = BeamHeights(ground, down, some_pose, seen_on, 1).heights();
  for (std::size_t i = 0; i < change.size(); ++i)
    EXPECT_NEAR(change.data()[i], (above.data()[i] - below.data()[i]) / (2 * step), 1e-4);
  for (int k = 0; k < pose_numbers; ++k) {
    PoseChange one{}, more{}, less{};
    one[k] = 1, more[k] = step, less[k] = -step;
    const Grid<double>
        by = seen.change(one),
        after = BeamHeights(ground, z, changed(some_pose, seen_on, more), seen_on, 1).heights(),
        before = BeamHeights(ground, z, changed(some_pose, seen_on, less), seen_on, 1).heights();
    for (std::size_t i = 0; i < by.size(); ++i)
      EXPECT_NEAR(by.data()[i], (after.data()[i] - before.data()[i]) / (2 * step),
                  1e-4 * (1 + largest(by)))
          << k;
  }
}

TEST(BeamHeights, TransposesAreExact) {
  const BeamHeights seen(ground, heights(test::small_height), some_pose, seen_on, 1);
  NormalNumbers normal(4, 1);
  Grid<double> dz(ground.width, ground.height), w(seen_on.width, seen_on.height), back = dz;
  PoseChange pose;
  for (double& v : dz.data()) v = normal();
  for (double& v : w.data()) v = normal();
  for (double& v : pose) v = normal();
  seen.scatter(w, back);
  const Grid<double> change = seen.change(dz), moved = seen.change(pose);
  const PoseChange by = seen.by_pose(w);
  double left = 0, right = 0, left_pose = 0, right_pose = 0;
  for (std::size_t i = 0; i < w.size(); ++i) left += w.data()[i] * change.data()[i];
  for (std::size_t i = 0; i < dz.size(); ++i) right += dz.data()[i] * back.data()[i];
  for (std::size_t i = 0; i < w.size(); ++i) left_pose += w.data()[i] * moved.data()[i];
  for (int k = 0; k < pose_numbers; ++k) right_pose += pose[k] * by[k];
  EXPECT_NEAR(left, right, 1e-9 * std::fabs(left));
  EXPECT_NEAR(left_pose, right_pose, 1e-9 * std::fabs(left_pose));
}

/// A further image of the small scene, as a microscope at this pose sees its surface.
SemView view_of(const test::SmallScene& scene, const ViewPose& pose, std::uint64_t seed,
                double noise = 1, double gain = 100) {
  SemView view;
  view.sem = scene.sem;
  view.pose = pose;
  view.sem.gains = {gain};
  HeightField along = scene.truth;
  for (int y = 0; y < along.z_nm.height(); ++y)
    for (int x = 0; x < along.z_nm.width(); ++x)
      along.z_nm(x, y) =
          met(test::small_height, pose, pose.to_plane({along.x_nm(x), along.y_nm(y)}), 120);
  view.sem.image.values = scene.sem.model->predict(along)[0];
  NormalNumbers normal(seed, 7);
  for (double& v : view.sem.image.values.data()) {
    v = gain * v + 20;
    v += noise * std::sqrt(view.sem.noise.variance(v)) * normal();
  }
  return view;
}

Objective with_views(const test::SmallScene& scene, const std::vector<SemView>& views,
                     const Grid<double>& z) {
  Objective o{.prior = CurvaturePrior(10, 2e-3), .frame = frame_of(&scene.afm, &scene.sem, 8)};
  o.sem.emplace(scene.sem, o.frame, 8, 8, 1);
  for (const SemView& view : views) o.views.emplace_back(view, o.frame, z, 8, 1);
  o.anchor_per_nm2 = 1e-3;
  o.start = Grid<double>(o.frame.width, o.frame.height, 7);
  o.fit_mixture = true;
  return o;
}

TEST(Objective, GradientHoldsWithViews) {
  const test::SmallScene scene;
  const std::vector<SemView> views{view_of(scene, {6, 20, {}}, 1),
                                   view_of(scene, {12, 200, {1, 0, 30, 0, 1, 0}}, 2)};
  const SurfaceFrame frame = frame_of(&scene.afm, &scene.sem, 8);
  Unknowns at{on_frame(scene.truth, frame, {}), {}, {{90}, 25, 0, 0}};
  NormalNumbers normal(2, 1);
  for (double& z : at.z_nm.data()) z += 2 * normal();
  const Objective o = with_views(scene, views, at.z_nm);
  for (int v = 0; v < 2; ++v)
    at.views.push_back({{0.3, 0.2, -0.1, 0.5, 0.1, 0, 0.2, -0.3}, {{95}, 22, 0, 0}});
  const Step g = o.gradient(at, o.evaluate(at));
  const auto expect = [&](const Step& direction, double tolerance) {
    const double step = 1e-2;  // the places that beams meet are found to some 1e-6 of a sample
    Step up = o.zero(), down = o.zero();
    add(up, step, direction), add(down, -step, direction);
    const double difference =
        (o.evaluate(o.moved(at, up)).value() - o.evaluate(o.moved(at, down)).value()) / (2 * step);
    EXPECT_NEAR(dot(g, direction), difference, tolerance * (std::fabs(difference) + 1));
  };
  Step all = o.zero();
  for (double& z : all.z_nm.data()) z = normal();
  expect(all, 5e-3);
  for (std::size_t v = 0; v < views.size(); ++v)
    for (int k = 0; k < pose_numbers + 2; ++k) {
      Step one = o.zero();
      (k < pose_numbers ? one.views[v].pose[k] : one.views[v].mixture[k - pose_numbers]) = 1;
      expect(one, 5e-3);
    }
  // The second derivative is symmetric and positive.
  const Objective::State s = o.evaluate(at);
  const Objective::Near near = o.near(at, s);
  Step other = o.zero();
  for (double& z : other.z_nm.data()) z = normal();
  for (ViewChange& v : other.views)
    for (double& k : v.pose) k = normal();
  const Step a = o.product(at, s, all, &near), b = o.product(at, s, other, &near);
  EXPECT_NEAR(dot(other, a), dot(all, b), 1e-9 * std::fabs(dot(other, b)));
  EXPECT_GT(dot(other, b), 0);
}

TEST(Reconstruct, ASecondViewFindsItsPlaceAndHelpsTheSurface) {
  const test::SmallScene scene(7);
  const ViewPose truth{10, 0, {1, 0, 0, 0, 1, 0}};
  SemView view = view_of(scene, truth, 3, 1, 120);
  view.sem.gains = {100};
  view.pose.to_plane.x0 = 12;  // off by more than a pixel
  view.pose.tilt_deg = 10.3;
  const Reconstruction one = reconstruct(&scene.afm, &scene.sem, test::quick()),
                       two = reconstruct(&scene.afm, &scene.sem, {view}, test::quick());
  EXPECT_LT(scene.rms_error(two.surface), scene.rms_error(one.surface));
  ASSERT_EQ(two.views.size(), 1u);
  const ViewResult& found = two.views[0];
  EXPECT_NEAR(found.pose.to_plane.x0, 0, 1.5);
  EXPECT_NEAR(found.pose.tilt_deg, 10, 0.3);
  EXPECT_NEAR(found.gains[0], 120, 3);
  EXPECT_TRUE(found.statistics.like_noise);
  EXPECT_TRUE(two.converged);
}

TEST(Reconstruct, RefusesImpossibleViews) {
  const test::SmallScene scene;
  SemView view = view_of(scene, {10, 0, {}}, 3);
  const auto refused = [&](const SemView& v, ReconstructionOptions o = test::quick()) {
    EXPECT_THROW(reconstruct(&scene.afm, &scene.sem, {v}, o), Error);
  };
  SemView wrong = view;
  wrong.pose.tilt_deg = 75;
  refused(wrong);
  wrong = view, wrong.tilt_error_deg = 0;
  refused(wrong);
  wrong = view, wrong.sem.gains = {1, 2};
  refused(wrong);
  wrong = view, wrong.pose.to_plane = {0, 0, 0, 0, 0, 0};
  refused(wrong);
  ReconstructionOptions descent = test::quick();
  descent.method = ReconstructionMethod::lbfgs;
  refused(view, descent);
  EXPECT_THROW(reconstruct(&scene.afm, nullptr, {view}, test::quick()), Error);
}

}  // namespace
}  // namespace surf::reconstruction
