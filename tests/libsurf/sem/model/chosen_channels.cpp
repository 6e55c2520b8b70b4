// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/chosen_channels.h"

#include <gtest/gtest.h>

#include "sem/model_checks.h"
#include "sem/model_surfaces.h"
#include "surf/core/error.h"
#include "surf/sem/slope_model.h"

namespace surf {
namespace {

std::shared_ptr<const ImageModel> three_channels() {
  return make_slope_model(
      {}, {SlopeForm::secant, 5, {5, 0.6}, {{"SE", 0.9, {}}, {"BSE", 0.2, {}}, {"x", 3, {}}}});
}

TEST(ChosenChannels, AreThoseOfTheModelInTheOrderAsked) {
  const auto all = three_channels();
  const auto some = with_channels(all, {"x", "SE"});
  const HeightField field = test::rough_field(30, 20);
  EXPECT_EQ(some->channels(), (std::vector<std::string>{"x", "SE"}));
  const ModelImages images = some->predict(field), whole = all->predict(field);
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0], whole[2]);
  EXPECT_EQ(images[1], whole[0]);
  EXPECT_EQ(some->linearize(field)->images(), images);
}

TEST(ChosenChannels, DeriveAsTheModelDoes) {
  const auto some = with_channels(three_channels(), {"x", "SE"});
  const HeightField field = test::rough_field(30, 20);
  test::expect_adjoint(*some, field, Edge::mirror, 1e-12);
  test::expect_exact_derivatives(*some, field, Edge::mirror, 1e-4, 1e-6);
  EXPECT_THROW(some->linearize(field)->gradient(test::random_weights(field, 3)), InvalidInput);
}

TEST(ChosenChannels, AllOfThemAreTheModelAndOthersAreRefused) {
  const auto all = three_channels();
  EXPECT_EQ(with_channels(all, {"SE", "BSE", "x"}), all);
  EXPECT_THROW(with_channels(all, {"CL"}), InvalidInput);
  EXPECT_THROW(with_channels(all, {"SE", "SE"}), InvalidInput);
  EXPECT_THROW(with_channels(all, {}), InvalidInput);
}

}  // namespace
}  // namespace surf
