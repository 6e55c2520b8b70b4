// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/image_model.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "sem/model/model_input.h"
#include "sem/model_surfaces.h"
#include "surf/core/error.h"
#include "surf/sem/training_image.h"

namespace {

using namespace surf;

template <class Error, class Work>
std::string message(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(ImageModel, NamesBothPixelSizes) {
  const ModelScope scope{3, "", 0, 0};
  HeightField field = test::rough_field(8, 8, 1);
  std::string text = message<InvalidInput>([&] { check_field(scope, field); });
  EXPECT_SAYS(text, "every 1 nm");
  EXPECT_SAYS(text, "for 3 nm");
  EXPECT_SAYS(text, "Resample");
  field.pitch_x_nm = field.pitch_y_nm = 3.002;
  EXPECT_NO_THROW(check_field(scope, field));
  field.pitch_y_nm = 2;
  text = message<InvalidInput>([&] { check_field(scope, field); });
  EXPECT_SAYS(text, "3.002 nm along x");
  EXPECT_SAYS(text, "2 nm along y");
  EXPECT_NO_THROW(check_field({}, field));
}

TEST(ImageModel, SaysHowToFillMaskedSamples) {
  HeightField field = test::rough_field(8, 8, 1);
  field.valid = Mask(8, 8, 1);
  EXPECT_NO_THROW(check_field({}, field));
  field.valid(2, 3) = 0;
  EXPECT_SAYS(message<InvalidInput>([&] { check_field({}, field); }), "semsurf clean");
}

TEST(ImageModel, NamesBothConditions) {
  const ModelScope scope{3, "Si", 1000, 0};
  EXPECT_NO_THROW(check_conditions(scope, {}));
  EXPECT_NO_THROW(check_conditions(scope, {3, "Si", 1000.5, 0}));
  std::string text = message<UsageError>([&] { check_conditions(scope, {3, "Au", 0, 0}); });
  EXPECT_SAYS(text, "made for Si");
  EXPECT_SAYS(text, "of Au");
  text = message<UsageError>([&] { check_conditions(scope, {3, "Si", 5000, 0}); });
  EXPECT_SAYS(text, "1000 eV");
  EXPECT_SAYS(text, "5000 eV");
  text = message<UsageError>([&] {
    check_conditions(scope, {3, "Si", 1000, 2});
  });  // a point, not any spot
  EXPECT_SAYS(text, "a spot of 0 nm");
  text = message<UsageError>([&] { check_conditions({0, "", 0, 1}, {0, "", 0, 2}); });
  EXPECT_SAYS(text, "1 nm");
  EXPECT_SAYS(text, "2 nm");
}

TrainingImage training_image() {
  return {"dots",
          test::rough_field(6, 5, 1),
          Edge::flat,
          {Grid<float>(6, 5, 1.0F), Grid<float>(6, 5, 2.0F)},
          {Grid<float>(6, 5, 0.1F), Grid<float>(6, 5, 0.1F)},
          {}};
}

TEST(TrainingImage, IsCheckedPixelByPixel) {
  EXPECT_NO_THROW(validate({training_image(), training_image()}));
  EXPECT_THROW(validate(std::vector<TrainingImage>{}), InvalidInput);
  const auto says = [](auto change, const char* part) {
    TrainingImage image = training_image();
    change(image);
    const std::string text = message<InvalidInput>([&] { validate({training_image(), image}); });
    EXPECT_SAYS(text, part);
  };
  says(
      [](auto& i) {
        i.images.pop_back();
        i.standard_errors.pop_back();
        i.name = "lines";
      },
      "lines");
  says([](auto& i) { i.images.clear(); }, "no channels");
  says([](auto& i) { i.images[1] = Grid<float>(5, 5); }, "5 x 5");
  says([](auto& i) { i.images[1](3, 2) = NAN; }, "column 3, row 2");
  says([](auto& i) { i.standard_errors[0](3, 2) = 0; }, "standard error");
  says([](auto& i) { i.standard_errors.pop_back(); }, "standard errors");
  says([](auto& i) { i.used = Mask(2, 2); }, "mask");
  TrainingImage masked = training_image();
  masked.used = Mask(6, 5, 1);
  masked.used(3, 2) = 0;
  masked.images[1](3, 2) = NAN;
  masked.standard_errors[1](3, 2) = 0;
  EXPECT_NO_THROW(validate({masked}));
}

TEST(ImageModel, ImagesMustBeFinite) {
  ModelImages images(2, Grid<double>(3, 2, 1e300));
  check_images(images, {"SE", "BSE"});
  images[1](2, 1) = std::numeric_limits<double>::infinity();
  EXPECT_NE(message<InvalidInput>([&] {
              check_images(images, {"SE", "BSE"});
            }).find("BSE"),
            std::string::npos);
}

}  // namespace
