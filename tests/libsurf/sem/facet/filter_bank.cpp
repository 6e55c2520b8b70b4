// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/filter_bank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "sem/model_checks.h"
#include "sem/model_surfaces.h"
#include "surf/core/error.h"

namespace {

using namespace surf;
using namespace surf::test;

constexpr Edge edges[] = {Edge::mirror, Edge::flat, Edge::periodic};

FilterBankParameters some_bank(bool multi_resolution = false) {
  FilterBankParameters p;
  p.scales = thesis_scales();
  p.multi_resolution = multi_resolution;
  RandomStream random(5, 0, 0);
  for (const char* name : {"SE", "BSE"}) {
    FilterBankChannel& c = p.channels.emplace_back();
    c.name = name;
    c.offset = random.uniform();
    for (std::size_t i = 0; i < p.scales.size(); ++i) {
      c.slope.push_back(random.uniform() - 0.3);
      c.max_curvature.push_back(2 * random.uniform() - 1);
      c.min_curvature.push_back(2 * random.uniform() - 1);
    }
  }
  return p;
}

std::shared_ptr<const ImageModel> bank(bool multi_resolution = false) {
  ModelScope scope;
  scope.pixel_nm = 2;
  return make_filter_bank(scope, some_bank(multi_resolution));
}

TEST(FilterBank, GivesWhatTheFormulasSayOfAPlaneAndABowl) {
  FilterBankParameters p{thesis_scales(), false, {{"SE", 0.5, {}, {}, {}}}};
  FilterBankChannel& c = p.channels[0];
  c.slope.assign(10, 1);
  c.max_curvature.assign(10, 2);
  c.min_curvature.assign(10, 7);
  const auto model = make_filter_bank({}, p);
  const HeightField plane =
      sampled(120, 120, 2, [](int x, int y) { return 2 * (0.3 * x + 0.4 * y); });
  const ModelOptions exact{.double_precision = true};
  EXPECT_NEAR(model->predict(plane, exact)[0](60, 60), 0.5 + 10 * 0.5, 1e-10);
  // Principal curvatures 0.02 and 0.006 /nm.
  const HeightField bowl = sampled(121, 121, 2, [](int x, int y) {
    return 0.5 * 4 * (0.02 * (x - 60) * (x - 60) + 0.006 * (y - 60) * (y - 60));
  });
  EXPECT_NEAR(model->predict(bowl, exact)[0](60, 60), 0.5 + 10 * (2 * 0.02 + 7 * 0.006), 1e-10);
}

TEST(FilterBank, TurnsWithTheSurface) {
  HeightField field = rough_field(70, 52);
  HeightField other = field;
  other.z_nm = turned(field.z_nm);
  // Not with subsampling, whose coarse grids begin at the lower left.
  for (const Edge edge : edges) {
    const ModelImages a = bank()->predict(field, {.edge = edge, .double_precision = true});
    const ModelImages b = bank()->predict(other, {.edge = edge, .double_precision = true});
    for (std::size_t c = 0; c < a.size(); ++c)
      EXPECT_LT(largest_difference(turned(a[c]), b[c]), 1e-11);
  }
}

TEST(FilterBank, KnowsNothingOfTheHeightAboveZero) {
  const HeightField field = rough_field(40, 61, 2, 0.1);
  HeightField high = field;
  for (double& z : high.z_nm.data()) z += 1048576;
  for (const bool multi : {false, true}) {
    const ModelImages a = bank(multi)->predict(field), b = bank(multi)->predict(high);
    // What the heights themselves lose in double, 1e-10 nm.
    for (std::size_t c = 0; c < a.size(); ++c) EXPECT_LT(largest_difference(a[c], b[c]), 2e-6);
  }
  HeightField flat = rough_field(40, 61, 2, 0);
  for (double& z : flat.z_nm.data()) z = 1e6 / 3;
  for (const bool multi : {false, true}) {
    const ModelImages images = bank(multi)->predict(flat);
    const FilterBankParameters p = some_bank();
    for (std::size_t c = 0; c < images.size(); ++c)
      for (const double v : images[c].data()) EXPECT_EQ(v, p.channels[c].offset);
  }
}

TEST(FilterBank, FloatIsAsGoodAsDouble) {
  for (const bool multi : {false, true}) {
    const auto model = bank(multi);
    const HeightField field = rough_field(120, 90);
    const auto fast = model->linearize(field),
               exact = model->linearize(field, {.double_precision = true});
    const ModelImages w = random_weights(field, 2);
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_LT(largest_difference(fast->images()[c], exact->images()[c]), 2e-4);
    const Grid<double> g = exact->gradient(w);
    double most = 0;
    for (const double v : g.data()) most = std::max(most, std::abs(v));
    EXPECT_LT(largest_difference(fast->gradient(w), g), 2e-4 * most);
  }
}

TEST(FilterBank, LinearizationIsExactOnRoughAndSteepSurfaces) {
  for (const bool multi : {false, true})
    for (const Edge edge : edges) {
      SCOPED_TRACE(std::string(multi ? "multi-resolution" : "full") + ", edge " +
                   std::to_string(int(edge)));
      expect_exact_derivatives(*bank(multi), rough_field(37, 29), edge, 1e-4, 2e-7);
      expect_exact_derivatives(*bank(multi), rough_field(37, 29, 2, 500), edge, 1e-2,
                               2e-7);  // slopes of hundreds
      expect_adjoint(*bank(multi), rough_field(61, 90), edge, 1e-12);
    }
}

// Blocks above one another, and an odd number of rows and columns.
TEST(FilterBank, GradientIsTheTransposeOnTallAndWideFields) {
  for (const bool multi : {false, true})
    for (const auto& [width, height] : {std::pair{41, 701}, {333, 39}})
      expect_adjoint(*bank(multi), rough_field(width, height), Edge::mirror, 1e-12);
}

// Where roots are zero the one-sided derivatives differ: their mean is what central differences
// give.
TEST(FilterBank, GradientIsTheTransposeWhereTilesMeet) {
  for (const bool multi_resolution : {false, true})
    for (const Edge edge : edges) {
      const auto model = bank(multi_resolution);
      expect_adjoint(*model, rough_field(530, 90), edge, 1e-12);
      expect_adjoint(*model, rough_field(90, 700), edge, 1e-12);
      expect_adjoint(*model, rough_field(560, 650), edge, 1e-12);
    }
}

TEST(FilterBank, LinearizationIsFiniteAndTheMeanOfBothSidesWhereRootsAreZero) {
  const HeightField flat = sampled(40, 40, 2, [](int, int) { return 7.0; });
  const HeightField plane = sampled(40, 40, 2, [](int x, int y) { return 0.25 * x - 0.5 * y; });
  const HeightField bowl = sampled(
      41, 41, 2, [](int x, int y) { return ((x - 20) * (x - 20) + (y - 20) * (y - 20)) / 64.0; });
  for (const bool multi : {false, true})
    for (const HeightField& field : {flat, plane, bowl})
      for (const Edge edge : edges) {
        expect_finite(*bank(multi), field, edge);
        expect_adjoint(*bank(multi), field, edge, 1e-12);
      }
  expect_exact_derivatives(*bank(), flat, Edge::mirror, 1e-3, 1e-9);
  expect_exact_derivatives(*bank(), plane, Edge::periodic, 1e-7, 1e-5);
  expect_exact_derivatives(*bank(), bowl, Edge::periodic, 1e-7, 1e-5);
  const HeightField sphere = sampled(40, 40, 2, [](int x, int y) {
    const double r2 = 4.0 * ((x - 20) * (x - 20) + (y - 20) * (y - 20));
    return r2 < 900 ? std::sqrt(900 - r2) : 0.0;
  });
  expect_finite(*bank(), sphere, Edge::mirror);
  expect_exact_derivatives(*bank(), sphere, Edge::flat, 1e-7, 1e-5);
}

TEST(FilterBank, SameBytesOnAnyNumberOfThreads) {
  for (const bool multi : {false, true}) {
    const auto model = bank(multi);
    const HeightField field = rough_field(100, 700);
    const auto one = model->linearize(field, {.threads = 1}),
               many = model->linearize(field, {.threads = 5});
    const ModelImages w = random_weights(field, 2);
    EXPECT_EQ(one->images(), many->images());
    EXPECT_EQ(one->images(), model->predict(field, {.threads = 3}));
    EXPECT_EQ(one->gradient(w), many->gradient(w));
    EXPECT_EQ(one->change(w[0]), many->change(w[0]));
  }
}

// Every border rule against a field that was continued by hand.
TEST(FilterBank, GoesOnBeyondTheBorderAsTheEdgeSays) {
  for (const auto& [width, height] : {std::pair{2, 2}, {4, 4}, {3, 50}, {50, 2}, {30, 23}})
    for (const Edge edge : edges)
      for (const bool multi : {false, true}) {
        const HeightField field = rough_field(width, height);
        const int margin = 96;  // whole coarse samples
        const auto at = [&](int i, int n) {
          if (edge == Edge::flat) return std::clamp(i, 0, n - 1);
          if (edge == Edge::periodic) return ((i % n) + n) % n;
          const int period = 2 * (n - 1), j = ((i % period) + period) % period;
          return j < n ? j : period - j;
        };
        const HeightField wide =
            sampled(width + 2 * margin, height + 2 * margin, 2, [&](int x, int y) {
              return field.z_nm(at(x - margin, field.z_nm.width()),
                                at(y - margin, field.z_nm.height()));
            });
        const ModelOptions exact{.edge = edge, .double_precision = true};
        const ModelImages a = bank(multi)->predict(field, exact),
                          b = bank(multi)->predict(wide, exact);
        for (std::size_t c = 0; c < a.size(); ++c)
          for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
              ASSERT_NEAR(a[c](x, y), b[c](x + margin, y + margin), 1e-10)
                  << width << " x " << height;
        if (!multi) expect_exact_derivatives(*bank(), field, edge, 1e-5, 1e-6);
        expect_adjoint(*bank(multi), field, edge, 1e-12);
      }
}

TEST(FilterBank, SubsamplingHardlyChangesWhatIsSmooth) {
  const HeightField field =
      sampled(120, 110, 2, [](int x, int y) { return 9 * std::sin(0.1 * x) * std::cos(0.08 * y); });
  const ModelImages a = bank()->predict(field), b = bank(true)->predict(field);
  double spread = 0;
  for (const double v : a[0].data()) spread = std::max(spread, std::abs(v - a[0](0, 0)));
  EXPECT_LT(largest_difference(a[0], b[0]), 0.2 * spread);
  EXPECT_GT(largest_difference(a[0], b[0]), 1e-4 * spread);  // it is another model
}

TEST(FilterBank, InstructionSetsAgreeAndDoNotDependOnThreads) {
  for (const bool multi : {false, true})
    expect_same_on_every_target([&] { return bank(multi); }, rough_field(50, 60));
}

TEST(FilterBank, StaysFiniteWhateverTheHeights) {
  for (const double relief : {1e-300, 1e-40, 1e-20, 1e9})
    for (const Edge edge : edges) expect_finite(*bank(), rough_field(12, 9, 2, relief), edge);
  EXPECT_THROW(bank()->predict(rough_field(12, 9, 2, 1e20)), InvalidInput);
  EXPECT_THROW(bank()->predict(rough_field(12, 9, 2, 1e307)), InvalidInput);
}

TEST(FilterBank, GradientKeepsUpWithWeightsOfAnySize) {
  const HeightField field = rough_field(20, 20);
  const auto linear = bank()->linearize(field);
  ModelImages w = random_weights(field, 2);
  const Grid<double> g = linear->gradient(w);
  for (const double unit : {0x1p-600, 0x1p600}) {
    ModelImages scaled = w;
    for (Grid<double>& image : scaled)
      for (double& v : image.data()) v *= unit;
    const Grid<double> h = linear->gradient(scaled);
    for (std::size_t i = 0; i < g.size(); ++i) EXPECT_EQ(h.data()[i], g.data()[i] * unit);
  }
}

TEST(FilterBank, RefusesBadFieldsAndWeights) {
  HeightField field = rough_field(20, 20);
  const auto model = bank();
  const auto linear = model->linearize(field);
  EXPECT_THROW(linear->gradient({Grid<double>(20, 20)}), InvalidInput);
  EXPECT_THROW(linear->gradient({Grid<double>(20, 20), Grid<double>(20, 19)}), InvalidInput);
  EXPECT_THROW(linear->gradient({Grid<double>(20, 20), Grid<double>(20, 20, std::nan(""))}),
               InvalidInput);
  EXPECT_THROW(linear->change(Grid<double>(19, 20)), InvalidInput);
  field.z_nm(3, 4) = std::nan("");
  EXPECT_THROW(model->predict(field), InvalidInput);
  EXPECT_THROW(model->linearize(field), InvalidInput);
}

TEST(FilterBank, RefusesBadParameters) {
  const auto refused = [](auto change) {
    FilterBankParameters p = some_bank();
    change(p);
    EXPECT_THROW(make_filter_bank({}, p), InvalidInput);
  };
  refused([](auto& p) { p.channels.clear(); });
  refused([](auto& p) { p.channels.resize(9, p.channels[0]); });
  refused([](auto& p) { p.channels[1].name = "SE"; });
  refused([](auto& p) { p.channels[1].name = ""; });
  refused([](auto& p) { p.scales.clear(); });
  refused([](auto& p) { p.scales[3].size = 12; });
  refused([](auto& p) { p.channels[0].slope.pop_back(); });
  refused([](auto& p) { p.channels[0].offset = std::numeric_limits<double>::infinity(); });
  refused([](auto& p) { p.channels[1].min_curvature[2] = std::nan(""); });
}

TEST(FilterBank, IsWatched) {
  for (const bool multi : {false, true}) expect_watched(*bank(multi), rough_field(150, 700));
}

}  // namespace
