// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/refinement/fit_modes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm/normal_numbers.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int width = 30, height = 20;
constexpr std::size_t modes = 6;

double shape(int x, int y) { return 1 + 0.4 * std::sin(0.5 * x) * std::cos(0.35 * y) + 0.02 * x; }

/// What mode k changes at a pixel, per nm: a blob of its own.
double effect(std::size_t k, int x, int y) {
  const double dx = x - 4.0 - 4.0 * static_cast<double>(k), dy = y - 10;
  return 0.05 * std::exp(-(dx * dx + dy * dy) / 18);
}

/// An image of a surface whose modes are off by `truth`, at gain 80 and offset 12.
RefinedView made_view(const std::vector<double>& truth, std::uint64_t seed, double noise,
                      double effect_noise = 0, double shift_nm = 0) {
  NormalNumbers normal(seed, 1);
  RefinedView view;
  view.placement.pitch_x_nm = view.placement.pitch_y_nm = 2;
  view.measured = view.simulated = Grid<double>(width, height);
  view.variance = Grid<double>(width, height, noise * noise);
  view.shift_error_nm = 100;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      view.simulated(x, y) = shape(x, y);
      double yield = shape(x, y) + shift_nm * (shape(x + 1, y) - shape(x - 1, y)) / 4;
      for (std::size_t k = 0; k < modes; ++k) yield += truth[k] * effect(k, x, y);
      view.measured(x, y) = 80 * yield + 12 + noise * normal();
    }
  for (std::size_t k = 0; k < modes; ++k) {
    ModeEffect e;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        e.pixels.push_back(static_cast<std::uint32_t>(y * width + x));
        e.first.push_back(effect(k, x, y) + effect_noise * normal());
        e.second.push_back(effect(k, x, y) + effect_noise * normal());
      }
    view.effects.push_back(std::move(e));
  }
  return view;
}

std::vector<double> wide_prior(double deviation_nm) {
  std::vector<double> out(modes * modes, 0);
  for (std::size_t k = 0; k < modes; ++k) out[k * modes + k] = deviation_nm * deviation_nm;
  return out;
}

const std::vector<double> nothing(modes, 0);

TEST(FitModes, FindsAmplitudesAndShift) {
  const std::vector<double> truth{1, -2, 0.5, 3, 0, -1};
  const ModeFit fit =
      fit_modes({made_view(truth, 1, 0.01, 0, 0.3)}, {{80, 12}}, nothing, wide_prior(100));
  for (std::size_t k = 0; k < modes; ++k) EXPECT_NEAR(fit.amplitudes_nm[k], truth[k], 0.05);
  EXPECT_NEAR(fit.views[0].shift_x_nm, 0.3, 0.03);
  EXPECT_NEAR(fit.step, 3.0 / 100, 0.001);
}

TEST(FitModes, FindsGainAndOffset) {
  const ModeFit fit = fit_modes({made_view(nothing, 1, 0.01)}, {{75, 15}}, nothing, wide_prior(1));
  EXPECT_NEAR(fit.views[0].gain, 80, 0.05);
  EXPECT_NEAR(fit.views[0].offset, 12, 0.1);
  RefinedViewState alone;
  fit_gain(made_view(nothing, 1, 0.01), alone);
  EXPECT_NEAR(alone.gain, 80, 0.05);
  EXPECT_NEAR(alone.offset, 12, 0.1);
}

TEST(FitModes, StandardErrorsHold) {
  double squares = 0;
  constexpr int fits = 60;
  for (int n = 0; n < fits; ++n) {
    NormalNumbers normal(static_cast<std::uint64_t>(n), 9);
    std::vector<double> truth(modes);
    for (double& a : truth) a = 2 * normal();
    const ModeFit fit = fit_modes({made_view(truth, static_cast<std::uint64_t>(n) + 100, 3)},
                                  {{80, 12}}, nothing, wide_prior(2));
    for (std::size_t k = 0; k < modes; ++k) {
      const double off = fit.amplitudes_nm[k] - truth[k];
      squares += off * off / fit.covariance[k * modes + k];
    }
  }
  // A mean of 360 squares, of which those of a fit are correlated.
  EXPECT_NEAR(squares / (fits * modes), 1, 0.25);
}

TEST(FitModes, ChanceInEffectsIsNoInformation) {
  RefinedView view = made_view(nothing, 5, 1);
  NormalNumbers normal(3, 3);
  for (ModeEffect& e : view.effects)
    for (std::size_t i = 0; i < e.pixels.size(); ++i)
      e.first[i] = 0.2 * normal(), e.second[i] = 0.2 * normal();
  const ModeFit fit = fit_modes({view}, {{80, 12}}, nothing, wide_prior(5));
  // Taken at its word it would be some 300 times as much.
  const double as_it_looks = 80 * 80 * 0.02 * width * height;
  for (std::size_t k = 0; k < modes; ++k) EXPECT_LT(fit.information[0][k], 0.15 * as_it_looks);
}

TEST(FitModes, NoisyEffectsKeepTheirInformation) {
  const ModeFit clean = fit_modes({made_view(nothing, 5, 1)}, {{80, 12}}, nothing, wide_prior(5)),
                noisy =
                    fit_modes({made_view(nothing, 5, 1, 0.01)}, {{80, 12}}, nothing, wide_prior(5));
  for (std::size_t k = 0; k < modes; ++k)
    EXPECT_NEAR(noisy.information[0][k] / clean.information[0][k], 1, 0.25);
}

TEST(FitModes, WhatNoImageTellsKeepsItsPrior) {
  RefinedView view = made_view(nothing, 7, 1);
  view.effects[2] = {};
  const ModeFit fit = fit_modes({view}, {{80, 12}}, nothing, wide_prior(5));
  EXPECT_NEAR(fit.covariance[2 * modes + 2], 25, 1e-6);
  EXPECT_EQ(fit.amplitudes_nm[2], 0);
  EXPECT_EQ(fit.information[0][2], 0);
  EXPECT_LT(fit.covariance[0], 1);
}

TEST(Blurred, KeepsSumsAndTellsTheSameAmplitudes) {
  const std::vector<double> truth{1, -2, 0.5, 3, 0, -1};
  const RefinedView view = made_view(truth, 1, 0.01), soft = blurred(view, 1.5);
  double before = 0, after = 0;
  for (const double e : view.effects[3].first) before += e;
  for (const double e : soft.effects[3].first) after += e;
  EXPECT_NEAR(after, before, 0.01 * before);
  const ModeFit fit = fit_modes({soft}, {{80, 12}}, nothing, wide_prior(100));
  for (std::size_t k = 0; k < modes; ++k) EXPECT_NEAR(fit.amplitudes_nm[k], truth[k], 0.05);
  EXPECT_EQ(blurred(view, 0).measured, view.measured);
}

TEST(FitModes, RefusesWhatDoesNotMatch) {
  RefinedView view = made_view(nothing, 7, 1);
  EXPECT_THROW(fit_modes({view}, {}, nothing, wide_prior(5)), InvalidInput);
  view.effects.pop_back();
  EXPECT_THROW(fit_modes({view}, {{80, 12}}, nothing, wide_prior(5)), InvalidInput);
}

TEST(VertexDeviations, AreThoseOfTheirModesTogether) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const std::vector<MeshMode> both{{{{0, {0, 0, 1}}}, {}, {}, 0}, {{{0, {1, 0, 0.5}}}, {}, {}, 0}};
  const std::vector<double> deviations = vertex_deviations(mesh, both, {4, 1, 1, 9});
  EXPECT_NEAR(deviations[0], std::sqrt(4 + 2 * 0.5 + 0.25 * 9), 1e-12);
  EXPECT_EQ(deviations[1], 0);
}

}  // namespace
}  // namespace surf
