// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/sem/image_model.h"
#include "vector_targets.h"

// What holds for every fast model of images.
namespace surf::test {

inline ModelImages random_weights(const HeightField& field, std::size_t channels,
                                  std::uint64_t seed = 11) {
  RandomStream random(seed, 0, 0);
  ModelImages weights(channels, Grid<double>(field.z_nm.width(), field.z_nm.height()));
  for (Grid<double>& image : weights)
    for (double& w : image.data()) w = 2 * random.uniform() - 1;
  return weights;
}

inline double dot(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a.data()[i] * b.data()[i];
  return sum;
}

inline double largest(const Grid<double>& a) {
  double most = 0;
  for (const double v : a.data()) most = std::max(most, std::abs(v));
  return most;
}

/// J dz against central differences of the images at `step_nm`, in parts of the largest; and <w, J
/// dz> against <J^T w, dz>.
inline void expect_exact_derivatives(const ImageModel& model, const HeightField& field, Edge edge,
                                     double step_nm, double tolerance) {
  const ModelOptions exact{.edge = edge, .double_precision = true};
  const auto linear = model.linearize(field, exact);
  EXPECT_EQ(linear->images(), model.predict(field, exact));
  const Grid<double> dz = random_weights(field, 1, 21)[0];
  HeightField up = field, down = field;
  for (std::size_t i = 0; i < dz.size(); ++i) {
    up.z_nm.data()[i] += step_nm * dz.data()[i];
    down.z_nm.data()[i] -= step_nm * dz.data()[i];
  }
  const ModelImages a = model.predict(up, exact), b = model.predict(down, exact),
                    change = linear->change(dz);
  const ModelImages w = random_weights(field, a.size());
  double slope = 0, size = 0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    Grid<double> difference = a[c];
    for (std::size_t i = 0; i < difference.size(); ++i)
      difference.data()[i] = (a[c].data()[i] - b[c].data()[i]) / (2 * step_nm);
    const double most = std::max(largest(difference), 1e-3);
    for (std::size_t i = 0; i < difference.size(); ++i)
      ASSERT_NEAR(change[c].data()[i], difference.data()[i], tolerance * most)
          << "channel " << c << ", pixel " << i;
    slope += dot(w[c], difference);
    size += most * std::sqrt(static_cast<double>(difference.size()));
  }
  EXPECT_NEAR(dot(linear->gradient(w), dz), slope, 10 * tolerance * size);
}

/// <w, J dz> = <J^T w, dz> to rounding.
inline void expect_adjoint(const ImageModel& model, const HeightField& field, Edge edge,
                           double tolerance) {
  const auto linear = model.linearize(field, {.edge = edge, .double_precision = true});
  const Grid<double> dz = random_weights(field, 1, 22)[0];
  const ModelImages w = random_weights(field, linear->images().size(), 23),
                    change = linear->change(dz);
  const Grid<double> gradient = linear->gradient(w);
  double a = 0, size = 0;
  for (std::size_t c = 0; c < w.size(); ++c) {
    a += dot(w[c], change[c]);
    size += std::sqrt(dot(w[c], w[c]) * dot(change[c], change[c]));
  }
  size += std::sqrt(dot(gradient, gradient) * dot(dz, dz));
  EXPECT_NEAR(a, dot(gradient, dz), tolerance * size);
}

inline void expect_finite(const ImageModel& model, const HeightField& field, Edge edge) {
  for (const bool exact : {false, true}) {
    const auto linear = model.linearize(field, {.edge = edge, .double_precision = exact});
    const ModelImages w = random_weights(field, linear->images().size());
    const auto finite = [](const Grid<double>& grid) {
      return std::all_of(grid.data().begin(), grid.data().end(),
                         [](double v) { return std::isfinite(v); });
    };
    for (const Grid<double>& image : linear->images()) EXPECT_TRUE(finite(image));
    for (const Grid<double>& image : linear->change(w[0])) EXPECT_TRUE(finite(image));
    EXPECT_TRUE(finite(linear->gradient(w)));
  }
}

/// Tells of a rising progress, and is left at the first look at a token that is set. Watched or
/// not, the same image.
inline void expect_watched(const ImageModel& model, const HeightField& field) {
  double last = 0;
  int told = 0;
  const auto tell = [&](double done, double total) {
    EXPECT_GT(done, last);
    EXPECT_LE(done, total);
    last = done;
    ++told;
  };
  EXPECT_EQ(model.predict(field, {.threads = 1, .watch = {tell, nullptr}}),
            model.predict(field, {.threads = 1}));
  EXPECT_GE(told, 4) << "blocks are small";
  CancelToken before;
  before.cancel();
  EXPECT_THROW(model.predict(field, {.watch = {{}, &before}}), Interrupted);
  EXPECT_THROW(model.linearize(field, {.watch = {{}, &before}}), Interrupted);
  CancelToken during;
  told = 0;
  const auto stop = [&](double, double) {
    ++told;
    during.cancel();
  };
  EXPECT_THROW(model.predict(field, {.threads = 1, .watch = {stop, &during}}), Interrupted);
  EXPECT_EQ(told, 1) << "it went on";
  // Derivatives outlive who watched.
  std::unique_ptr<Linearization> linear;
  {
    CancelToken gone;
    linear = model.linearize(field, {.threads = 1, .watch = {{}, &gone}});
    gone.cancel();
    EXPECT_NO_THROW(linear->change(field.z_nm));
    EXPECT_NO_THROW(linear->gradient(linear->images()));
  }
}

inline double largest_gap(const Grid<double>& a, const Grid<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::abs(a.data()[i] - b.data()[i]));
  return most;
}

/// On every instruction set that the machine has: images and gradient are the same for any number
/// of threads, to the last bit, and those of the others to rounding.
inline void expect_same_on_every_target(
    const std::function<std::shared_ptr<const ImageModel>()>& make, const HeightField& field) {
  std::vector<Grid<double>> first;
  for (const std::int64_t target : vector_targets()) {
    SCOPED_TRACE(name_of_target(target));
    const OnlyTarget only(target);
    const auto results = [&](int threads) {
      const auto linear = make()->linearize(field, {.threads = threads});
      std::vector<Grid<double>> all = linear->images();
      all.push_back(linear->gradient(random_weights(field, all.size())));
      return all;
    };
    const std::vector<Grid<double>> one = results(1);
    EXPECT_TRUE(results(3) == one);
    if (first.empty()) first = one;
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_LT(largest_gap(one[i], first[i]), 2e-5 * largest(first[i])) << i;
  }
}

}  // namespace surf::test
