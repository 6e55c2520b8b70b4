// SPDX-License-Identifier: GPL-3.0-or-later
#include "view_term.h"

#include <algorithm>
#include <cmath>

#include "damped_steps.h"
#include "initial_surface.h"

namespace surf::reconstruction {
namespace {

constexpr double largest_turn_deg = 1, largest_shift_px = 8;  // of one step

/// The image without the pixels whose beams miss the surface.
SemData seen(const SemView& view, const SurfaceFrame& surface, const Grid<double>& z,
             const SurfaceFrame& frame, int margin, int threads) {
  SemData data = view.sem;
  Mask& valid = data.image.valid;
  const int w = data.image.values.width(), h = data.image.values.height();
  if (valid.empty()) valid = Mask(w, h, 1);
  const BeamHeights heights(surface, z, view.pose, frame, threads);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (!heights.meets(x + margin, y + margin)) valid(x, y) = 0;
  return data;
}

}  // namespace

ViewTerm::ViewTerm(const SemView& view, const SurfaceFrame& surface, const Grid<double>& z,
                   int margin, int threads)
    : margin_(margin), threads_(threads), surface_(surface),
      frame_(frame_of(nullptr, &view.sem, margin)), given_(view.pose),
      sem_(seen(view, surface, z, frame_, margin, threads), frame_, margin, margin, threads) {
  const double half = 0.5 * std::max(frame_.width, frame_.height),
               of_scale = std::pow(view.scale_error * half, -2),
               of_tilt = std::pow(view.tilt_error_deg, -2);
  constexpr double of_place = 1e-8, held = 1e12;  // as good as none, and as good as exact
  if (view.same_scan) precision_.fill(held);
  else precision_ = {of_place, of_scale, of_scale, of_place, of_scale, of_scale, of_tilt, of_tilt};
}

ViewTerm::State ViewTerm::evaluate(const Grid<double>& z, const ViewUnknowns& at) const {
  State s;
  s.heights = std::make_shared<BeamHeights>(surface_, z, pose(at), frame_, threads_);
  s.sem = sem_.evaluate(s.heights->heights(), at.mixture);
  s.value = s.sem.value;
  for (int k = 0; k < pose_numbers; ++k) s.value += 0.5 * precision_[k] * at.pose[k] * at.pose[k];
  return s;
}

SemTerm::Near ViewTerm::near(const State& s, const ViewUnknowns& at) const {
  return sem_.near(s.sem, at.mixture);
}

void ViewTerm::add_gradient(const State& s, const ViewUnknowns& at, const Grid<double>& weights,
                            const SemTerm::Near* near, Grid<double>& out,
                            ViewChange* by_view) const {
  Grid<double> by_heights(frame_.width, frame_.height);
  sem_.add_gradient(s.sem, at.mixture, weights, near, by_heights,
                    by_view ? &by_view->mixture : nullptr);
  s.heights->scatter(by_heights, out);
  if (!by_view) return;
  const PoseChange by_pose = s.heights->by_pose(by_heights);
  for (int k = 0; k < pose_numbers; ++k) by_view->pose[k] += by_pose[k];
}

Grid<double> ViewTerm::change(const State& s, const ViewUnknowns& at, const Grid<double>& dz,
                              const ViewChange& view, const SemTerm::Near* near) const {
  Grid<double> rises = s.heights->change(dz);
  if (std::ranges::any_of(view.pose, [](double k) { return k != 0; })) {
    const Grid<double> by_pose = s.heights->change(view.pose);
    for (std::size_t i = 0; i < rises.size(); ++i) rises.data()[i] += by_pose.data()[i];
  }
  return sem_.change(s.sem, at.mixture, rises, view.mixture, near);
}

PoseChange ViewTerm::prior_pull(const ViewUnknowns& at) const {
  PoseChange out = at.pose;
  for (int k = 0; k < pose_numbers; ++k) out[k] *= precision_[k];
  return out;
}

std::array<std::array<double, ViewTerm::numbers>, ViewTerm::numbers> ViewTerm::block(
    const State& s, const ViewUnknowns& at, bool mixture, const SemTerm::Near* near) const {
  std::array<std::array<double, numbers>, numbers> out{};
  const Grid<double> none(surface_.width, surface_.height);
  std::vector<Grid<double>> images;
  const int fitted = pose_numbers + (mixture ? 2 : 0);
  for (int k = 0; k < fitted; ++k) {
    ViewChange unit;
    (k < pose_numbers ? unit.pose[k] : unit.mixture[k - pose_numbers]) = 1;
    images.push_back(change(s, at, none, unit, near));
  }
  for (int i = 0; i < fitted; ++i) {
    const Grid<double> weighed = sem_.precision(s.sem, images[i]);
    for (int k = 0; k < fitted; ++k)
      for (std::size_t p = 0; p < weighed.size(); ++p)
        out[i][k] += weighed.data()[p] * images[k].data()[p];
  }
  for (int k = 0; k < numbers; ++k) out[k][k] += k < pose_numbers ? precision_[k] : k >= fitted;
  return out;
}

ViewUnknowns ViewTerm::moved(const ViewUnknowns& at, const ViewChange& by, bool mixture) const {
  ViewUnknowns next = at;
  for (int k = 0; k < pose_numbers; ++k) {
    const double most = k < pose_tilt ? largest_shift_px : largest_turn_deg;
    next.pose[k] += std::clamp(by.pose[k], -most, most);
  }
  if (!mixture) return next;
  for (double& gain : next.mixture.gains) gain *= 1 + by.mixture[0];
  next.mixture.offset += by.mixture[1];
  return next;
}

void ViewTerm::fit(const Grid<double>& z, ViewUnknowns& at, bool mixture,
                   const Watch& watch) const {
  constexpr int iterations = 20;
  State state = evaluate(z, at);
  DampedSteps steps;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    watch.check();
    const auto given = block(state, at, mixture, nullptr);
    Grid<double> unused(surface_.width, surface_.height);
    ViewChange g;
    add_gradient(state, at, state.sem.pull, nullptr, unused, &g);
    const PoseChange prior = prior_pull(at);
    Eigen::MatrixXd a(numbers, numbers);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(numbers);
    for (int i = 0; i < numbers; ++i) {
      for (int k = 0; k < numbers; ++k) a(i, k) = given[i][k];
      if (i < pose_numbers) pull(i) = g.pose[i] + prior[i];
      else if (mixture) pull(i) = g.mixture[i - pose_numbers];
    }
    const double fell = steps.step(a, pull, [&](const Eigen::VectorXd& d) {
      ViewChange step;
      for (int k = 0; k < pose_numbers; ++k) step.pose[k] = d(k);
      for (int k = 0; k < 2; ++k) step.mixture[k] = d(pose_numbers + k);
      const ViewUnknowns next = moved(at, step, mixture);
      State there = evaluate(z, next);
      const double lower = state.value - there.value;
      if (lower > 0) at = next, state = std::move(there);
      return lower;
    });
    if (fell < settled_step) return;
  }
}

}  // namespace surf::reconstruction
