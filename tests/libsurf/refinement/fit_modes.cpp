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

/// Likewise, but the second mode does nearly what the first does.
double alike(std::size_t k, int x, int y) {
  return k == 1 ? 0.95 * effect(0, x, y) + 0.1 * effect(1, x, y) : effect(k, x, y);
}

using Effect = double (*)(std::size_t, int, int);

/// An image of a surface whose modes are off by `truth`, at gain 80 and offset 12.
RefinedView made_view(const std::vector<double>& truth, std::uint64_t seed, double noise,
                      double effect_noise = 0, double shift_nm = 0, Effect own = effect) {
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
      for (std::size_t k = 0; k < modes; ++k) yield += truth[k] * own(k, x, y);
      view.measured(x, y) = 80 * yield + 12 + noise * normal();
    }
  for (std::size_t k = 0; k < modes; ++k) {
    ModeEffect e;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        e.pixels.push_back(static_cast<std::uint32_t>(y * width + x));
        e.first.push_back(own(k, x, y) + effect_noise * normal());
        e.second.push_back(own(k, x, y) + effect_noise * normal());
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
  for (const double shift_nm : {0.0, 0.3}) {
    const ModeFit fit =
        fit_modes({made_view(truth, 1, 0.1, 0, shift_nm)}, {{80, 12}}, nothing, wide_prior(20));
    // The slopes that shifts are told by are those of smoothed images.
    for (std::size_t k = 0; k < modes; ++k)
      EXPECT_NEAR(fit.amplitudes_nm[k], truth[k], shift_nm > 0 ? 0.1 : 0.03);
    EXPECT_NEAR(fit.views[0].shift_x_nm, shift_nm, 0.03);
    EXPECT_NEAR(fit.step, 3.0 / 20, 0.005);
  }
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

/// The last of some steps, between which the image is simulated anew.
ModeFit in_steps(const RefinedView& view, Effect own) {
  RefinedView now = view;
  ModeFit fit;
  fit.amplitudes_nm = nothing, fit.views = {{80, 12}};
  constexpr int steps = 8;
  for (int step = 0; step < steps; ++step) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        now.simulated(x, y) = view.simulated(x, y);
        for (std::size_t k = 0; k < modes; ++k)
          now.simulated(x, y) += fit.amplitudes_nm[k] * own(k, x, y);
      }
    fit = fit_modes({now}, fit.views, fit.amplitudes_nm, wide_prior(2));
  }
  return fit;
}

/// Mean square of errors over their standard errors, of a mode or of all.
double mean_square(double effect_noise, Effect own, std::size_t first, std::size_t last) {
  double squares = 0;
  constexpr int fits = 60;
  for (int n = 0; n < fits; ++n) {
    NormalNumbers normal(static_cast<std::uint64_t>(n), 9);
    std::vector<double> truth(modes);
    for (double& a : truth) a = 2 * normal();
    const ModeFit fit = in_steps(
        made_view(truth, static_cast<std::uint64_t>(n) + 100, 3, effect_noise, 0, own), own);
    for (std::size_t k = first; k < last; ++k) {
      const double off = fit.amplitudes_nm[k] - truth[k];
      squares += off * off / fit.covariance[k * modes + k];
    }
  }
  return squares / static_cast<double>(fits * (last - first));
}

TEST(FitModes, StandardErrorsHold) {
  // A mean of 360 squares, of which those of a fit are correlated.
  EXPECT_NEAR(mean_square(0, effect, 0, modes), 1, 0.25);
}

// Chance in the effects of two modes that do nearly the same looks like what parts them.
TEST(FitModes, StandardErrorsHoldWhereNoisyEffectsAreAlike) {
  EXPECT_LT(mean_square(0.01, alike, 0, 2), 1.5);
}

/// The largest amplitude, in standard errors.
double largest(const ModeFit& fit) {
  double most = 0;
  for (std::size_t k = 0; k < modes; ++k)
    most =
        std::max(most, std::abs(fit.amplitudes_nm[k]) / std::sqrt(fit.covariance[k * modes + k]));
  return most;
}

TEST(FitModes, WhatSimulationsAreOffByInWidePartsIsNoSurface) {
  std::vector<RefinedView> views;
  for (const double error : {0.0, 20.0}) {
    views.push_back(made_view(nothing, 3, 1));
    views.back().wide_error = error, views.back().wide_nm = 10;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) views.back().measured(x, y) += 8 * std::sin(0.1 * x);
  }
  const ModeFit taken_in = fit_modes({views[0]}, {{80, 12}}, nothing, wide_prior(2)),
                known = fit_modes({views[1]}, {{80, 12}}, nothing, wide_prior(2));
  EXPECT_GT(largest(taken_in), 10);
  EXPECT_LT(largest(known), 3);
  const Grid<double> found = simulation_error(views[1], known.views[0], views[1].simulated);
  EXPECT_NEAR(found(15, 2) - found(1, 2), 8 * (std::sin(1.5) - std::sin(0.1)), 4);
}

/// An image of the surface itself, whose pixels have another relation to the simulated ones.
RefinedView other_image(double (*pixel)(int, int)) {
  RefinedView view = made_view(nothing, 3, 1);
  NormalNumbers normal(4, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) view.measured(x, y) = 12 + 80 * pixel(x, y) + normal();
  return view;
}

TEST(FitModes, BentYieldsAreNoSurface) {
  RefinedView view = other_image([](int x, int y) {
    const double s = shape(x, y);
    return s + 0.5 * (s - 1.3) * (s - 1.3);
  });
  const ModeFit taken_in = fit_modes({view}, {{80, 12}}, nothing, wide_prior(2));
  view.bend_error = 0.3;
  const ModeFit known = fit_modes({view}, {{80, 12}}, nothing, wide_prior(2));
  EXPECT_GT(largest(taken_in), 10);
  EXPECT_LT(largest(known), 3);
  const Grid<double> found = simulation_error(view, known.views[0], view.simulated);
  const double bright = shape(23, 0) - 1.3, middle = shape(14, 10) - 1.3;
  EXPECT_NEAR(found(23, 0) - found(14, 10), 40 * (bright * bright - middle * middle), 5);
}

TEST(FitModes, AWiderSpotIsNoSurface) {
  constexpr double blur_nm2 = 4, bright_nm2 = 50;
  // A bright edge: a Gaussian along x, which another one widens.
  const auto edge = [](int x, double variance_nm2) {
    const double off_nm = 2.0 * (x - 15);
    return std::sqrt(bright_nm2 / variance_nm2) * std::exp(-0.5 * off_nm * off_nm / variance_nm2);
  };
  RefinedView view = made_view(nothing, 3, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double waves = shape(x, y) - 1 - 0.02 * x,  // of 0.5 and 0.35 per pixel of 2 nm
          damped = std::exp(-0.5 * blur_nm2 * (0.25 * 0.25 + 0.175 * 0.175));
      view.simulated(x, y) += edge(x, bright_nm2);
      view.measured(x, y) += 80 * (edge(x, bright_nm2 + blur_nm2) + (damped - 1) * waves);
    }
  const ModeFit taken_in = fit_modes({view}, {{80, 12}}, nothing, wide_prior(2));
  view.blur_error_nm2 = 4;
  const ModeFit known = fit_modes({view}, {{80, 12}}, nothing, wide_prior(2));
  EXPECT_GT(largest(taken_in), 10);
  EXPECT_LT(largest(known), 4);  // a Laplacian is the first term only
  EXPECT_NEAR(known.views[0].blur_nm2, blur_nm2, 1.2);
}

TEST(Misfit, IsLeastAtTheFit) {
  RefinedView view = made_view({1, -2, 0.5, 3, 0, -1}, 1, 3);
  view.wide_error = 5, view.wide_nm = 20, view.bend_error = 0.1, view.blur_error_nm2 = 1;
  const std::vector<RefinedViewState> start{{80, 12}};
  const ModeFit fit = fit_modes({view}, start, nothing, wide_prior(2));
  // As the fit sees it, to the first order.
  const auto at = [&](const std::vector<double>& amplitudes, const RefinedViewState& state) {
    RefinedView there = view;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (std::size_t k = 0; k < modes; ++k)
          there.simulated(x, y) += amplitudes[k] * effect(k, x, y);
    return misfit({there}, {state}, amplitudes, wide_prior(2));
  };
  RefinedViewState state = fit.views[0];
  state.shift_x_nm = state.shift_y_nm = 0;
  const double least = at(fit.amplitudes_nm, state);
  EXPECT_LT(least, at(nothing, start[0]));
  for (std::size_t k = 0; k < modes; ++k) {
    double rise = 0;
    for (const double by : {-1.0, 1.0}) {
      std::vector<double> other = fit.amplitudes_nm;
      other[k] += by;
      EXPECT_LT(least, at(other, state)) << k;
      rise += at(other, state) - least;
    }
    // By what is told of the amplitude, and by its prior of 2 nm.
    EXPECT_NEAR(rise / (2 * (fit.information[0][k] + 0.25)), 1, 0.05);
  }
}

TEST(FitModes, StepsKeepWhatTheyPromiseAndDampingShortensThem) {
  RefinedView view = made_view({1, -2, 0.5, 3, 0, -1}, 1, 3);
  const std::vector<RefinedViewState> start{{80, 12}};
  const std::vector<double> begin{0.2, 0.4, -0.3, 0, 1, 0};
  view.shift_error_nm = 1e-6;
  const auto after = [&](const ModeFit& fit, double share) {
    RefinedView there = view;
    std::vector<double> amplitudes = begin;
    RefinedViewState state = start[0];
    state.gain += share * (fit.views[0].gain - state.gain);
    state.offset += share * (fit.views[0].offset - state.offset);
    for (std::size_t k = 0; k < modes; ++k) {
      const double by = share * (fit.amplitudes_nm[k] - begin[k]);
      amplitudes[k] += by;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) there.simulated(x, y) += by * effect(k, x, y);
    }
    return misfit({there}, {state}, amplitudes, wide_prior(2));
  };
  double shorter = 10, less = 1e9;
  for (const double damping : {0.0, 10.0, 1000.0}) {
    const ModeFit fit = fit_modes({view}, start, begin, wide_prior(2), damping);
    EXPECT_NEAR((after(fit, 1) - after(fit, 0)) / fit.promised, 1, 0.02) << damping;
    EXPECT_LT(-fit.promised, less);
    EXPECT_LT(fit.step, shorter);
    shorter = fit.step, less = -fit.promised;
  }
  const ModeFit whole = fit_modes({view}, start, begin, wide_prior(2)),
                part = fit_modes({view}, start, begin, wide_prior(2), 10);
  EXPECT_EQ(whole.covariance, part.covariance);
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

// Chance in a simulated image looks like contrast that the measured one does not have.
TEST(FitModes, ChanceInSimulatedImagesIsNoContrast) {
  const std::vector<double> truth{1, -2, 0.5, 3, 0, -1};
  RefinedView view = made_view(truth, 1, 1);
  view.first_half = view.second_half = view.simulated;
  NormalNumbers normal(8, 2);
  constexpr double chance = 0.3;
  for (std::size_t p = 0; p < view.simulated.size(); ++p) {
    double &first = view.first_half.data()[p], &second = view.second_half.data()[p];
    first += chance * normal(), second += chance * normal();
    view.simulated.data()[p] = 0.5 * (first + second);
    view.variance.data()[p] = 1 + 0.5 * 80 * 80 * chance * chance;
  }
  RefinedView at_its_word = view;
  at_its_word.first_half = at_its_word.second_half = {};
  RefinedViewState taken_in, known;
  fit_gain(at_its_word, taken_in), fit_gain(view, known);
  EXPECT_LT(taken_in.gain, 65);
  EXPECT_NEAR(known.gain, 80, 6);
  view.blur_error_nm2 = at_its_word.blur_error_nm2 = 4;
  const ModeFit deceived = fit_modes({at_its_word}, {{80, 12}}, nothing, wide_prior(2)),
                fit = fit_modes({view}, {{80, 12}}, nothing, wide_prior(2));
  EXPECT_GT(deceived.views[0].blur_nm2, 2);  // a blurred image has less chance
  EXPECT_LT(std::abs(fit.views[0].blur_nm2), 1);
  EXPECT_NEAR(fit.views[0].gain, 80, 6);
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
  EXPECT_NEAR(fit.amplitudes_nm[2], 0, 1e-6);
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
