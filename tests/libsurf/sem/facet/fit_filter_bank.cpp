// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/fit_filter_bank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

#include "sem/model_surfaces.h"
#include "surf/core/error.h"

namespace {

using namespace surf;
using namespace surf::test;

double normal(RandomStream& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

/// A bank whose coefficients are all there to be found.
FilterBankParameters truth(const std::vector<FacetScale>& scales) {
  FilterBankParameters p{scales, false, {}};
  RandomStream random(9, 0, 0);
  for (const char* name : {"SE", "BSE"}) {
    FilterBankChannel c{name, 1 + random.uniform(), {}, {}, {}};
    for (std::size_t i = 0; i < scales.size(); ++i) {
      c.slope.push_back(random.uniform());
      c.max_curvature.push_back(random.uniform() - 0.5);
      c.min_curvature.push_back(random.uniform() - 0.5);
    }
    p.channels.push_back(c);
  }
  return p;
}

/// Images of a bank with noise.
TrainingImage imaged(const FilterBankParameters& bank, const HeightField& field, Edge edge,
                     double noise, std::uint64_t seed) {
  const ModelImages images =
      make_filter_bank({}, bank)->predict(field, {.edge = edge, .double_precision = true});
  TrainingImage t{"surface " + std::to_string(seed), field, edge, {}, {}, {}};
  RandomStream random(seed, 0, 1);
  for (const Grid<double>& image : images) {
    Grid<float> noisy(image.width(), image.height()), errors(image.width(), image.height());
    for (std::size_t i = 0; i < image.size(); ++i) {
      errors.data()[i] =
          static_cast<float>(noise > 0 ? noise * (1 + 4 * (i % 2)) : 1);  // every other is worse
      noisy.data()[i] =
          static_cast<float>(image.data()[i] + (noise > 0 ? errors.data()[i] * normal(random) : 0));
    }
    t.images.push_back(noisy);
    t.standard_errors.push_back(errors);
  }
  return t;
}

const std::vector<FacetScale> three = {{5, 0.6}, {11, 1.697}, {29, 4.8}};

TEST(FitFilterBank, FindsTheCoefficientsThatMadeTheImages) {
  const FilterBankParameters bank = truth(three);
  const std::vector<TrainingImage> images = {
      imaged(bank, rough_field(70, 60, 2, 5, 1), Edge::mirror, 0, 1),
      imaged(bank, rough_field(50, 400, 2, 9, 2), Edge::periodic, 0, 2)};
  const FilterBankFit fit =
      fit_filter_bank(images, {"SE", "BSE"}, {.scales = three, .eigenvalue_cutoff = 0});
  EXPECT_EQ(fit.components, 9);
  ASSERT_EQ(fit.eigenvalues.size(), 9U);
  double total = 0;
  for (const double e : fit.eigenvalues) total += e;
  EXPECT_NEAR(total, 9, 1e-9);  // of a correlation matrix
  for (int c = 0; c < 2; ++c) {
    EXPECT_EQ(fit.parameters.channels[c].name, bank.channels[c].name);
    EXPECT_NEAR(fit.parameters.channels[c].offset, bank.channels[c].offset, 1e-5);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(fit.parameters.channels[c].slope[i], bank.channels[c].slope[i], 1e-5);
      EXPECT_NEAR(fit.parameters.channels[c].max_curvature[i], bank.channels[c].max_curvature[i],
                  1e-4);
      EXPECT_NEAR(fit.parameters.channels[c].min_curvature[i], bank.channels[c].min_curvature[i],
                  1e-4);
    }
  }
}

TEST(FitFilterBank, WeighsPixelsByTheirStandardErrorAndReportsNoiseApart) {
  const FilterBankParameters bank = truth(three);
  std::vector<TrainingImage> images = {imaged(bank, rough_field(120, 120), Edge::mirror, 0.2, 3)};
  const auto error_of = [&](const FilterBankFit& fit) {
    double sum = 0;
    for (int c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < 3; ++i)
        sum += std::pow(fit.parameters.channels[c].slope[i] - bank.channels[c].slope[i], 2);
    return std::sqrt(sum);
  };
  const FilterBankFit weighted =
      fit_filter_bank(images, {"SE", "BSE"}, {.scales = three, .eigenvalue_cutoff = 0});
  for (const ModelResidual& r : weighted.residuals) {
    EXPECT_NEAR(r.noise_rms, 0.2 * std::sqrt(13.0), 1e-3);  // of 1 and 5 times 0.2
    EXPECT_LT(r.rms, 0.15 * r.noise_rms);
    EXPECT_EQ(r.pixels, 120 * 120);
    EXPECT_GT(r.mean_signal, 0);
    EXPECT_GT(r.mean_relative, 0);
  }
  images[0].standard_errors.clear();
  const FilterBankFit plain =
      fit_filter_bank(images, {"SE", "BSE"}, {.scales = three, .eigenvalue_cutoff = 0});
  EXPECT_LT(error_of(weighted), 0.7 * error_of(plain));
  EXPECT_EQ(plain.residuals[0].noise_rms, 0);
}

TEST(FitFilterBank, LeavesOutPixelsThatAreNotUsed) {
  const FilterBankParameters bank = truth(three);
  TrainingImage image = imaged(bank, rough_field(64, 48), Edge::flat, 0, 4);
  image.used = Mask(64, 48, 1);
  for (int y = 10; y < 20; ++y)
    for (int x = 0; x < 64; ++x) {
      image.used(x, y) = 0;
      image.images[0](x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  const FilterBankFit fit =
      fit_filter_bank({image}, {"SE", "BSE"}, {.scales = three, .eigenvalue_cutoff = 0});
  EXPECT_LT(fit.residuals[0].rms, 1e-5);
  EXPECT_EQ(fit.residuals[0].pixels, 64 * 38);
  for (unsigned char& used : image.used.data()) used = 0;
  EXPECT_THROW(fit_filter_bank({image}, {"SE", "BSE"}, {.scales = three}), InvalidInput);
}

TEST(FitFilterBank, SameNumbersOnAnyNumberOfThreads) {
  const std::vector<TrainingImage> images = {
      imaged(truth(three), rough_field(90, 700), Edge::mirror, 0.1, 5)};
  const FilterBankFit one = fit_filter_bank(images, {"SE", "BSE"}, {.scales = three, .threads = 1});
  const FilterBankFit many =
      fit_filter_bank(images, {"SE", "BSE"}, {.scales = three, .threads = 4});
  EXPECT_EQ(one.eigenvalues, many.eigenvalues);
  EXPECT_EQ(one.parameters.channels[1].min_curvature, many.parameters.channels[1].min_curvature);
}

/// Images of no filter bank: bright edges that saturate, and noise as of counted electrons.
TrainingImage counted(const HeightField& field, std::uint64_t seed, double noise = 0.03) {
  FilterBankParameters bank = truth(thesis_scales());
  TrainingImage t = imaged(bank, field, Edge::mirror, 0, seed);
  RandomStream random(seed, 0, 2);
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t i = 0; i < t.images[c].size(); ++i) {
      float& value = t.images[c].data()[i];
      value = static_cast<float>(0.3 + std::tanh(0.1 * std::abs(value)));
      t.standard_errors[c].data()[i] = static_cast<float>(noise);
      value += static_cast<float>(noise * normal(random));
    }
  return t;
}

TEST(FitFilterBank, SaysWhenTheCutOffLeavesTheLeastSquaresIllConditioned) {
  // Smooth bumps: neighbouring scales see nearly the same.
  const std::vector<TrainingImage> images = {
      counted(sampled(40, 40, 3,
                      [](int x, int y) {
                        return 8 * std::sin(0.21 * x + 0.05 * y) * std::cos(0.17 * y) +
                               5 * std::sin(0.4 * y - 0.1 * x);
                      }),
              6, 0.3)};
  const std::vector<TrainingImage> others = {
      counted(sampled(80, 80, 3,
                      [](int x, int y) {
                        return std::hypot(x - 40, y - 40) < 15
                                   ? 20.0
                                   : 0.0;  // a raised disc, of another kind than what was seen
                      }),
              7, 0.01)};
  double last_condition = 0, sound_error = 0, unsound_error = 0, last_training = 1e9;
  for (const double cutoff : {1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 0.0}) {
    const FilterBankFit fit = fit_filter_bank(images, {"SE", "BSE"}, {.eigenvalue_cutoff = cutoff});
    const bool warned =
        !fit.warnings.empty() && fit.warnings[0].find("ill-conditioned") != std::string::npos;
    const double held_out = residuals_of(*make_filter_bank({}, fit.parameters), others)[0].rms;
    if (std::getenv("SEMSURF_PRINT_SWEEP"))
      std::printf("cut-off %g: %d components, condition %.1f, rms %.4f, held out %.4f%s\n", cutoff,
                  fit.components, fit.condition_number, fit.residuals[0].rms, held_out,
                  warned ? ", warned" : "");
    EXPECT_GE(fit.condition_number, last_condition);
    EXPECT_LE(fit.residuals[0].rms, last_training * (1 + 1e-9));
    EXPECT_EQ(warned, fit.condition_number > 100);
    if (cutoff == 0.1) {
      EXPECT_FALSE(warned);
      sound_error = held_out;
    }
    if (cutoff == 0) {
      EXPECT_TRUE(warned);
      unsound_error = held_out;
    }
    last_condition = fit.condition_number;
    last_training = fit.residuals[0].rms;
  }
  EXPECT_GT(unsound_error, 1.5 * sound_error);
}

TEST(FitFilterBank, SaysWhenThereIsTooLittleToLearnFrom) {
  const FilterBankFit small = fit_filter_bank({counted(rough_field(8, 8), 8)}, {"SE", "BSE"});
  bool said = false;
  for (const std::string& warning : small.warnings)
    said |= warning.find("few") != std::string::npos;
  EXPECT_TRUE(said);
  const FilterBankFit flat =
      fit_filter_bank({counted(rough_field(30, 30, 2, 0), 9)}, {"SE", "BSE"});
  EXPECT_EQ(flat.components, 0);
  ASSERT_FALSE(flat.warnings.empty());
  EXPECT_NE(flat.warnings[0].find("no relief"), std::string::npos);
  const ModelImages images = make_filter_bank({}, flat.parameters)->predict(rough_field(20, 20));
  for (const double v : images[0].data()) EXPECT_EQ(v, flat.parameters.channels[0].offset);
}

TEST(FitFilterBank, LearnsAMicroscopesOneSignal) {
  const FilterBankParameters signal = fold_calibration(truth(three), {40, -7}, 100);
  TrainingImage image = imaged(signal, rough_field(60, 60), Edge::mirror, 0, 10);
  const FilterBankFit fit =
      fit_filter_bank({image}, {"signal"}, {.scales = three, .eigenvalue_cutoff = 0});
  EXPECT_NEAR(fit.parameters.channels[0].offset, signal.channels[0].offset, 1e-3);
  EXPECT_THROW(fit_filter_bank({image}, {"SE", "BSE"}), InvalidInput);
  EXPECT_THROW(fit_filter_bank({image}, {"signal"}, {.eigenvalue_cutoff = -1}), UsageError);
  EXPECT_THROW(fit_filter_bank({image}, {"signal"}, {.eigenvalue_cutoff = std::nan("")}),
               UsageError);
}

TEST(FoldCalibration, IsTheCombinationOfTheImages) {
  const FilterBankParameters bank = truth(thesis_scales());
  const HeightField field = rough_field(40, 50);
  const ModelOptions exact{.double_precision = true};
  const ModelImages images = make_filter_bank({}, bank)->predict(field, exact);
  const FilterBankParameters folded = fold_calibration(bank, {120, -35}, 17);
  const auto model = make_filter_bank({}, folded);
  EXPECT_EQ(model->channels(), std::vector<std::string>{"signal"});
  const ModelImages signal = model->predict(field, exact);
  for (std::size_t i = 0; i < signal[0].size(); ++i)
    EXPECT_NEAR(signal[0].data()[i], 120 * images[0].data()[i] - 35 * images[1].data()[i] + 17,
                1e-9);
  EXPECT_THROW(fold_calibration(bank, {1}, 0), InvalidInput);
  EXPECT_THROW(fold_calibration(bank, {1, std::nan("")}, 0), InvalidInput);
  EXPECT_THROW(fold_calibration(bank, {1, 2}, std::nan("")), InvalidInput);
}

}  // namespace
