// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/facet_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "sem/model_checks.h"
#include "sem/model_surfaces.h"
#include "sem/network/sky_view.h"
#include "surf/core/error.h"
#include "surf/sem/fit_facet_network.h"
#include "surf/sem/fit_filter_bank.h"

namespace {

using namespace surf;
using namespace surf::test;

constexpr Edge all_edges[] = {Edge::mirror, Edge::flat, Edge::periodic};

TEST(FitFacetNetwork, LooksNoFartherThanPixelsAllow) {
  EXPECT_EQ(network_sky_edges(1, 9000), (std::vector<double>{0, 128}));
  const std::vector<double> edges = network_sky_edges(3, 30);
  ASSERT_EQ(edges.size(), 7U);
  EXPECT_NEAR(edges.back(), 160, 0.2);
  EXPECT_EQ(network_scales(1, 30).size(), 10U);
  EXPECT_EQ(network_scales(3, 30).size(), 7U);
  EXPECT_EQ(network_scales(10, 5).size(), 4U);
}

DenseLayer random_layer(int inputs, int outputs, RandomStream& random) {
  DenseLayer layer{inputs, outputs, {}, {}};
  for (int i = 0; i < inputs * outputs; ++i) layer.weights.push_back(2 * random.uniform() - 1);
  for (int i = 0; i < outputs; ++i) layer.biases.push_back(random.uniform() - 0.5);
  return layer;
}

FacetNetworkParameters some_network(std::vector<int> hidden = {11, 6}, bool sky = true,
                                    bool sided = false) {
  FacetNetworkParameters p;
  p.sided = sided;
  p.scales = {{5, 0.6}, {7, 0.8485}, {15, 2.4}, {9, 0}};
  if (sky) p.sky_edges_nm = {0, 3, 9, 30};
  p.channels = {{"SE", 0.9}, {"BSE", 0.2}};
  RandomStream random(3, 0, 0);
  int inputs = network_inputs(p);
  hidden.push_back(2);
  for (const int units : hidden) {
    p.layers.push_back(random_layer(inputs, units, random));
    inputs = units;
  }
  return p;
}

std::shared_ptr<const ImageModel> network(const FacetNetworkParameters& p = some_network()) {
  ModelScope scope;
  scope.pixel_nm = 2;
  return make_facet_network(scope, p);
}

std::shared_ptr<const ImageModel> sided_network() {
  return network(some_network({11, 6}, true, true));
}

TEST(FacetNetwork, InstructionSetsAgreeAndDoNotDependOnThreads) {
  expect_same_on_every_target([] { return network(); }, rough_field(50, 60));
  expect_same_on_every_target([] { return sided_network(); }, rough_field(50, 60));
}

/// The one input i of a network, as a channel: its last layer inverts o + sqrt(1 + o^2).
double input(int i, const HeightField& field, int x, int y, bool sided = false) {
  FacetNetworkParameters p = some_network({}, true, sided);
  DenseLayer& layer = p.layers[0];
  layer.outputs = 1;
  layer.weights.assign(layer.inputs, 0.0);
  layer.weights[i] = 1;
  layer.biases.assign(1, 0.0);
  p.channels = {{"input", 1}};
  const double v = network(p)->predict(field, {.double_precision = true})[0](x, y);
  return 0.5 * (v - 1 / v);
}

double c(double x) { return x / std::pow(1 + x * x, 0.25); }

TEST(FacetNetwork, InputsAreWhatTheFormulasSayOfAParaboloid) {
  // Second derivatives 0.02 and 0.006 /nm; at sample (50, 30) the slopes are 0.4 and 0.
  const HeightField bowl = sampled(61, 61, 2, [](int x, int y) {
    return 0.5 * 4 * (0.02 * (x - 40) * (x - 40) + 0.006 * (y - 30) * (y - 30));
  });
  const double sigma[] = {0.6, 0.8485, 2.4, 9 / std::sqrt(12.0)};
  for (int s = 0; s < 4; ++s) {
    const double length = 2 * sigma[s] * 2, g2 = 0.16;
    EXPECT_NEAR(input(4 * s, bowl, 50, 30), std::pow(1 + g2, 0.25) - 1, 1e-9);
    EXPECT_NEAR(input(4 * s + 1, bowl, 50, 30), c(0.5 * 0.026 * length), 1e-9);
    EXPECT_NEAR(input(4 * s + 2, bowl, 50, 30),
                std::pow(1 + std::pow(0.5 * 0.014 * length, 2), 0.25) - 1, 1e-9);
    EXPECT_NEAR(input(4 * s + 3, bowl, 50, 30), c(length * 0.5 * 0.02 * g2 / (1 + g2)), 1e-9);
  }
}

TEST(FacetNetwork, SidedInputsSayWhereTheSurfaceFacesAndWhatHidesTheSky) {
  // A wall of slope 0.75 that rises towards +x, and one towards -y.
  const HeightField east = sampled(61, 61, 2, [](int x, int) { return 0.75 * 2 * x; });
  const HeightField south = sampled(61, 61, 2, [](int, int y) { return -0.75 * 2 * y; });
  const double steep = 0.75 / std::pow(1 + 0.75 * 0.75, 0.25);
  for (int s = 0; s < 4; ++s) {
    EXPECT_NEAR(input(6 * s + 4, east, 30, 30, true), steep, 1e-9);
    EXPECT_NEAR(input(6 * s + 5, east, 30, 30, true), 0, 1e-9);
    EXPECT_NEAR(input(6 * s + 4, south, 30, 30, true), 0, 1e-9);
    EXPECT_NEAR(input(6 * s + 5, south, 30, 30, true), -steep, 1e-9);
  }
  // What rises hides the sky there: the mean direction of what is open is the other one.
  for (int band = 0; band < 3; ++band) {
    EXPECT_GT(input(24 + 4 * band + 2, east, 30, 30, true), 0.2);
    EXPECT_NEAR(input(24 + 4 * band + 3, east, 30, 30, true), 0, 1e-9);
    EXPECT_LT(input(24 + 4 * band + 3, south, 30, 30, true), -0.2);
  }
  EXPECT_LT(input(24 + 13, east, 30, 30, true), -0.1);
  EXPECT_NEAR(input(24 + 14, east, 30, 30, true), 0, 1e-9);
  EXPECT_GT(input(24 + 14, south, 30, 30, true), 0.1);
}

TEST(FacetNetwork, SidedInputsKeepTheOthers) {
  const HeightField field = rough_field(40, 33);
  const auto same = [&](int sided, int plain) {
    EXPECT_EQ(input(sided, field, 20, 16, true), input(plain, field, 20, 16)) << plain;
  };
  for (int s = 0; s < 4; ++s)
    for (int i = 0; i < 4; ++i) same(6 * s + i, 4 * s + i);
  for (int band = 0; band < 3; ++band)
    for (int i = 0; i < 2; ++i) same(24 + 4 * band + i, 16 + 2 * band + i);
  same(36, 22);
}

TEST(FacetNetwork, SkyInputsAreWhatTheFormulasSayInACone) {
  // From the bottom of a cone everything is seen at the same elevation.
  const double slope = 0.75, sine = 0.6;
  const HeightField pit =
      sampled(81, 81, 2, [&](int x, int y) { return slope * 2 * std::hypot(x - 40, y - 40); });
  const network::SkyView view({0, 3, 9, 30}, 2);
  double open = 0, factor = 1;
  int per_direction = 0;
  for (const auto& sample : view.samples()) {
    factor *= 1 - 0.9 * sine * sine;
    ++per_direction;
    if (!sample.last) continue;
    open += factor / 16;
    factor = 1;
    per_direction = 0;
  }
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR(input(16 + 2 * band, pit, 40, 40), sine, 1e-9);
    EXPECT_NEAR(input(17 + 2 * band, pit, 40, 40), sine * sine, 1e-9);
  }
  EXPECT_NEAR(input(22, pit, 40, 40), open, 1e-9);
  // On a summit nothing rises.
  HeightField peak = pit;
  for (double& z : peak.z_nm.data()) z = -z;
  EXPECT_NEAR(input(16, peak, 40, 40), -sine, 1e-9);
  EXPECT_NEAR(input(22, peak, 40, 40), 1, 1e-12);
}

TEST(FacetNetwork, SkyLooksAtEveryBandInEveryDirection) {
  for (const double pitch : {0.5, 1.0, 3.0, 10.0}) {
    const network::SkyView view({0, 4, 10, 20, 40}, pitch);
    std::vector<double> weights(4, 0.0);
    int directions = 0;
    for (const auto& s : view.samples()) {
      weights[s.band] += s.weight;
      directions += s.last;
      EXPECT_NEAR(s.distance_nm, std::hypot(s.dx, s.dy) * pitch, 1e-9);
      EXPECT_LE(s.distance_nm, std::max(40.0, 2.3 * pitch) + 1e-9);
    }
    EXPECT_EQ(directions, 16);
    for (const double w : weights) EXPECT_NEAR(w, 1, 1e-12);
  }
}

TEST(FacetNetwork, TurnsWithTheSurface) {
  const HeightField field = rough_field(40, 33);
  HeightField other = field;
  other.z_nm = turned(field.z_nm);
  for (const Edge edge : all_edges) {
    const ModelImages a = network()->predict(field, {.edge = edge, .double_precision = true});
    const ModelImages b = network()->predict(other, {.edge = edge, .double_precision = true});
    for (std::size_t ch = 0; ch < a.size(); ++ch)
      EXPECT_LT(largest_difference(turned(a[ch]), b[ch]), 1e-11);
  }
}

TEST(FacetNetwork, KnowsNothingOfTheHeightAboveZero) {
  const HeightField field = rough_field(40, 31, 2, 0.1);
  HeightField high = field;
  for (double& z : high.z_nm.data()) z += 1048576;
  const ModelImages a = network()->predict(field), b = network()->predict(high);
  for (std::size_t ch = 0; ch < a.size(); ++ch) EXPECT_LT(largest_difference(a[ch], b[ch]), 5e-6);
}

TEST(FacetNetwork, FloatIsAsGoodAsDouble) {
  const HeightField field = rough_field(70, 50);
  for (const auto& model : {network(), sided_network()}) {
    const auto fast = model->linearize(field),
               exact = model->linearize(field, {.double_precision = true});
    for (std::size_t ch = 0; ch < 2; ++ch)
      EXPECT_LT(largest_difference(fast->images()[ch], exact->images()[ch]),
                2e-4 * largest(exact->images()[ch]));
    const ModelImages w = random_weights(field, 2);
    const Grid<double> g = exact->gradient(w);
    EXPECT_LT(largest_difference(fast->gradient(w), g), 5e-4 * largest(g));
  }
}

TEST(FacetNetwork, RootsAreAsGoodAsSinglePrecision) {
  // The sky view alone: fits in single precision are not as good.
  const HeightField field = rough_field(40, 30, 2, 60);
  FacetNetworkParameters p = some_network({});
  p.scales = {{5, 0.6}};
  DenseLayer& layer = p.layers[0];
  layer.inputs = network_inputs(p);
  layer.outputs = 1;
  layer.biases.assign(1, 0.0);
  p.channels = {{"input", 1}};
  for (int i = 4; i < layer.inputs; ++i) {
    layer.weights.assign(layer.inputs, 0.0);
    layer.weights[i] = 1;
    const auto model = network(p);
    EXPECT_LT(largest_difference(model->predict(field)[0],
                                 model->predict(field, {.double_precision = true})[0]),
              2e-6)
        << i;
  }
}

TEST(FacetNetwork, GradientIsTheTransposeWhereTilesMeet) {
  const HeightField field = rough_field(610, 530);
  for (const Edge edge : all_edges) expect_adjoint(*network(), field, edge, 1e-12);
  expect_adjoint(*sided_network(), field, Edge::mirror, 1e-12);
  const auto fast = network()->linearize(field),
             exact = network()->linearize(field, {.double_precision = true});
  const ModelImages w = random_weights(field, 2);
  const Grid<double> g = exact->gradient(w);
  EXPECT_LT(largest_difference(fast->gradient(w), g), 5e-4 * largest(g));
}

TEST(FacetNetwork, LinearizationIsExact) {
  const HeightField flat = sampled(30, 30, 2, [](int, int) { return 7.0; });
  const HeightField plane = sampled(30, 30, 2, [](int x, int y) { return 0.25 * x - 0.5 * y; });
  const HeightField bowl = sampled(
      31, 31, 2, [](int x, int y) { return ((x - 15) * (x - 15) + (y - 15) * (y - 15)) / 64.0; });
  const HeightField sphere = sampled(40, 40, 2, [](int x, int y) {
    const double r2 = 4.0 * ((x - 20) * (x - 20) + (y - 20) * (y - 20));
    return r2 < 900 ? std::sqrt(900 - r2) : 0.0;
  });
  for (const auto& hidden : {std::vector<int>{}, {7}, {11, 6}})
    for (const auto& [sky, sided] : {std::pair{true, false}, {false, false}, {true, true}}) {
      const auto model = network(some_network(hidden, sky, sided));
      for (const Edge edge : all_edges) {
        SCOPED_TRACE(std::to_string(hidden.size()) + " hidden layers, edge " +
                     std::to_string(int(edge)));
        expect_exact_derivatives(*model, rough_field(37, 29), edge, 1e-4, 1e-6);
        expect_exact_derivatives(*model, rough_field(37, 29, 2, 60), edge, 1e-4, 1e-5);
        for (const HeightField& field : {flat, plane, bowl, sphere}) {
          // Where nothing rises the sky's second derivative jumps: small steps.
          expect_exact_derivatives(*model, field, edge, 1e-6, 1e-5);
          expect_adjoint(*model, field, edge, 1e-12);
          expect_finite(*model, field, edge);
        }
      }
    }
}

TEST(FacetNetwork, SmallFieldsAreContinuedAsOftenAsItTakes) {
  for (const auto& [width, height] : {std::pair{2, 2}, {4, 4}, {3, 50}, {50, 2}})
    for (const Edge edge : all_edges) {
      const HeightField field = rough_field(width, height);
      expect_finite(*network(), field, edge);
      expect_exact_derivatives(*network(), field, edge, 1e-4, 1e-5);
      expect_adjoint(*network(), field, edge, 1e-12);
    }
}

TEST(FacetNetwork, SameBytesOnAnyNumberOfThreads) {
  const HeightField field = rough_field(100, 700);
  const auto one = network()->linearize(field, {.threads = 1}),
             many = network()->linearize(field, {.threads = 5});
  const ModelImages w = random_weights(field, 2);
  EXPECT_EQ(one->images(), many->images());
  EXPECT_EQ(one->gradient(w), many->gradient(w));
  EXPECT_EQ(one->change(w[0]), many->change(w[0]));
}

TEST(FacetNetwork, RefusesWhatItCannotBe) {
  const auto refuses = [](auto&& spoil) {
    FacetNetworkParameters p = some_network();
    spoil(p);
    EXPECT_THROW(network(p), InvalidInput);
  };
  refuses([](auto& p) { p.scales.clear(); });
  refuses([](auto& p) { p.scales[0].size = 6; });
  refuses([](auto& p) { p.layers.clear(); });
  refuses([](auto& p) { p.layers[1].inputs = 10; });
  refuses([](auto& p) { p.layers[0].weights.pop_back(); });
  refuses([](auto& p) { p.layers[0].biases[1] = std::numeric_limits<double>::quiet_NaN(); });
  refuses([](auto& p) { p.channels.pop_back(); });
  refuses([](auto& p) { p.channels[1].name = "SE"; });
  refuses([](auto& p) { p.channels[1].scale = 0; });
  refuses([](auto& p) { p.sky_edges_nm = {0, 5, 5}; });
  refuses([](auto& p) { p.sky_edges_nm = {1, 5}; });
  EXPECT_THROW(make_facet_network({}, some_network()), InvalidInput);  // no pixel size
  HeightField field = rough_field(20, 20);
  field.z_nm(3, 4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(network()->predict(field), InvalidInput);
  EXPECT_THROW(network()->predict(rough_field(20, 20, 3)), InvalidInput);  // other pixels
}

TrainingImage taught_by(const ImageModel& teacher, std::uint64_t seed, double noise) {
  TrainingImage image;
  image.name = "surface " + std::to_string(seed);
  image.field = rough_field(60, 50, 2, 2 + static_cast<double>(seed % 5), seed);
  RandomStream random(seed, 1, 0);
  for (const Grid<double>& truth : teacher.predict(image.field)) {
    Grid<float> seen(60, 50), error(60, 50);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      error.data()[i] = static_cast<float>(noise * std::sqrt(truth.data()[i]));
      const double normal = std::sqrt(-2 * std::log(random.uniform())) *
                            std::cos(2 * std::numbers::pi * random.uniform());
      seen.data()[i] = static_cast<float>(truth.data()[i] + error.data()[i] * normal);
    }
    image.images.push_back(std::move(seen));
    image.standard_errors.push_back(std::move(error));
  }
  return image;
}

/// Signals of the heights around a pixel, mirrored at the border.
class Taught final : public ImageModel {
 public:
  using Heights = std::function<double(int x, int y)>;
  using Signals = std::function<std::vector<double>(const Heights& z, int x, int y)>;

  Taught(std::vector<std::string> names, Signals signals)
      : names_(std::move(names)), signals_(std::move(signals)) {}
  const std::vector<std::string>& channels() const override { return names_; }
  const ModelScope& scope() const override { return scope_; }
  ModelImages predict(const HeightField& field, const ModelOptions&) const override {
    const int w = field.z_nm.width(), h = field.z_nm.height();
    const Heights z = [&](int i, int j) {
      return field.z_nm(std::abs(std::min(i, 2 * w - 2 - i)), std::abs(std::min(j, 2 * h - 2 - j)));
    };
    ModelImages images(names_.size(), Grid<double>(w, h));
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const std::vector<double> signals = signals_(z, x, y);
        for (std::size_t c = 0; c < images.size(); ++c) images[c](x, y) = signals[c];
      }
    return images;
  }
  std::unique_ptr<Linearization> linearize(const HeightField&, const ModelOptions&) const override {
    return nullptr;
  }

 private:
  std::vector<std::string> names_;
  Signals signals_;
  ModelScope scope_;
};

/// Slopes as their neighbours see them: smooth, positive, not a network.
Taught teacher() {
  return {{"SE", "BSE"}, [](const Taught::Heights& z, int x, int y) {
            const double sx = (z(x + 1, y) - z(x - 1, y)) / 4, sy = (z(x, y + 1) - z(x, y - 1)) / 4;
            const double bend =
                (z(x + 2, y) + z(x - 2, y) + z(x, y + 2) + z(x, y - 2) - 4 * z(x, y)) / 16;
            return std::vector{std::sqrt(1 + sx * sx + sy * sy) / (1 + std::exp(bend)),
                               0.2 + 0.1 * std::tanh(std::hypot(sx, sy)) - 0.05 * std::tanh(bend)};
          }};
}

FacetNetworkFitOptions quick() {
  FacetNetworkFitOptions o;
  o.scales = {{5, 0.6}, {7, 0.8485}, {9, 1.2}, {15, 2.4}};
  o.range_nm = 20;
  o.hidden = {12};
  o.iterations = 150;
  return o;
}

TEST(FitFacetNetwork, LearnsWhatALinearBankCannotAndSaysHowFarItIsOff) {
  std::vector<TrainingImage> images;
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    images.push_back(taught_by(teacher(), seed, 0.05));
  const FacetNetworkFit fit = fit_facet_network(images, {"SE", "BSE"}, quick());
  ASSERT_EQ(fit.residuals.size(), 2U);
  EXPECT_EQ(fit.parameters.channels[1].name, "BSE");
  EXPECT_LE(fit.iterations, 150);
  EXPECT_NEAR(fit.cost, 1, 0.25);  // residuals are noise, and what the model is given to miss by
  const auto bank = fit_filter_bank(images, {"SE", "BSE"});
  const auto held = taught_by(teacher(), 77, 1e-6);
  ModelScope scope;
  scope.pixel_nm = 2;
  const auto judged = residuals_of(*make_facet_network(scope, fit.parameters), {held});
  const auto judged_bank = residuals_of(*make_filter_bank(scope, bank.parameters), {held});
  EXPECT_LT(judged[0].rms, 0.05 * judged[0].mean_signal);
  EXPECT_LT(judged[0].rms, 0.5 * judged_bank[0].rms);
  // The residual on the training images, less their noise, is about the one without noise.
  EXPECT_NEAR(fit.residuals[0].rms / fit.residuals[0].mean_signal,
              judged[0].rms / judged[0].mean_signal, 0.03);
}

TEST(FitFacetNetwork, LearnsWhatADetectorAtASideSees) {
  // Lambert's law, lit from +x: a network without sides cannot tell the two flanks of a hill apart.
  const Taught lambert({"BSE-right"}, [](const Taught::Heights& z, int x, int y) {
    return std::vector{0.5 - 0.3 * std::tanh((z(x + 1, y) - z(x - 1, y)) / 4)};
  });
  std::vector<TrainingImage> images;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) images.push_back(taught_by(lambert, seed, 0.05));
  const auto held = taught_by(lambert, 77, 1e-6);
  ModelScope scope;
  scope.pixel_nm = 2;
  const auto off = [&](bool sided) {
    FacetNetworkFitOptions o = quick();
    o.sided = sided;
    const FacetNetworkFit fit = fit_facet_network(images, {"BSE-right"}, o);
    EXPECT_EQ(fit.parameters.sided, sided);
    return residuals_of(*make_facet_network(scope, fit.parameters), {held})[0].rms;
  };
  const double sided = off(true), blind = off(false);
  EXPECT_LT(sided, 0.05);
  EXPECT_LT(sided, 0.25 * blind);
}

TEST(FitFacetNetwork, SameNumbersOnAnyNumberOfThreads) {
  std::vector<TrainingImage> images{taught_by(teacher(), 1, 0.05), taught_by(teacher(), 2, 0.05),
                                    taught_by(teacher(), 3, 0.05)};
  FacetNetworkFitOptions o = quick();
  o.iterations = 12;
  o.threads = 1;
  const FacetNetworkFit one = fit_facet_network(images, {"SE", "BSE"}, o);
  o.threads = 4;
  const FacetNetworkFit four = fit_facet_network(images, {"SE", "BSE"}, o);
  for (std::size_t l = 0; l < one.parameters.layers.size(); ++l)
    EXPECT_EQ(one.parameters.layers[l].weights, four.parameters.layers[l].weights);
  o.seed = 2;
  EXPECT_NE(fit_facet_network(images, {"SE", "BSE"}, o).parameters.layers[0].weights,
            one.parameters.layers[0].weights);
}

TEST(FitFacetNetwork, LeavesOutWhatIsNotUsedAndKeepsPixelsOfOneImage) {
  std::vector<TrainingImage> images{taught_by(teacher(), 1, 0.05), taught_by(teacher(), 2, 0.05)};
  for (TrainingImage& image : images) {
    image.used = Mask(60, 50, 1);
    for (int x = 0; x < 60; ++x) {
      image.used(x, 7) = 0;
      image.images[0](x, 7) = 1e6F;
    }
  }
  FacetNetworkFitOptions o = quick();
  o.iterations = 60;
  const FacetNetworkFit fit = fit_facet_network(images, {"SE", "BSE"}, o);
  EXPECT_LT(fit.parameters.channels[0].scale, 3);
  ASSERT_EQ(fit.warnings.size(), 1U);
  EXPECT_NE(fit.warnings[0].find("few"), std::string::npos);
}

TEST(FitFacetNetwork, TellsHowFarItIsAndEndsWhenTold) {
  std::vector<TrainingImage> images{taught_by(teacher(), 1, 0.05)};
  FacetNetworkFitOptions o = quick();
  CancelToken token;
  double last = 0;
  o.watch.cancel = &token;
  o.watch.progress = [&](double done, double total) {
    EXPECT_GE(done, last);
    EXPECT_LE(done, total);
    last = done;
    if (done > 20) token.cancel();
  };
  EXPECT_THROW(fit_facet_network(images, {"SE", "BSE"}, o), Interrupted);
  EXPECT_GT(last, 20);
}

TEST(FitFacetNetwork, RefusesWhatItCannotLearnFrom) {
  std::vector<TrainingImage> images{taught_by(teacher(), 1, 0.05)};
  EXPECT_THROW(fit_facet_network(images, {"SE"}, quick()), InvalidInput);
  const auto refuses = [&](auto&& spoil) {
    FacetNetworkFitOptions o = quick();
    spoil(o);
    EXPECT_THROW(fit_facet_network(images, {"SE", "BSE"}, o), UsageError);
  };
  refuses([](auto& o) { o.range_nm = 0; });
  refuses([](auto& o) { o.hidden = {0}; });
  refuses([](auto& o) { o.iterations = 0; });
  refuses([](auto& o) { o.decay = -1; });
  refuses([](auto& o) { o.tolerance = std::nan(""); });
  for (float& v : images[0].images[1].data()) v = -v;
  EXPECT_THROW(fit_facet_network(images, {"SE", "BSE"}, quick()), InvalidInput);
}

TEST(FacetNetwork, IsWatched) { expect_watched(*network(), rough_field(150, 700)); }

}  // namespace
