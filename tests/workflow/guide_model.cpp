// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided/guide_model.h"

#include <gmock/gmock.h>

#include <cmath>

#include "guided/scene_guides.h"
#include "small_training.h"
#include "surf/core/error.h"
#include "surf/io/model/model_file.h"
#include "surf/mc/geometry/scene.h"
#include "surf/workflow/stored_model.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
namespace fs = std::filesystem;

/// Rough silicon under a beam, seen with pixels of this size.
mc::Scene scene(double pixel_nm, double tilt_deg = 0, const char* material = "Si") {
  mc::Specimen specimen;
  specimen.materials = {io::find_material(material, "test")};
  specimen.height_field = mc::HeightFieldBody{"rough", make_rough({150, 150, 3}, 4, 15, 1), 0};
  mc::Beam beam;
  beam.tilt_deg = tilt_deg;
  mc::Scan scan;
  scan.width = scan.height = static_cast<int>(std::lround(48 / pixel_nm));
  scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
  return {specimen, beam, scan};
}

class GuideModelTest : public testing::Test {
 protected:
  GuideModelTest() { run(small_training(file_)); }

  /// The model as the cache keeps it, for pixels of 3 nm.
  void keep() const {
    ModelRequest request;
    request.material = io::find_material("Si", "test");
    request.energy_ev = 1000;
    request.pixel_nm = 3;
    fs::create_directories(cache_ / "models");
    fs::copy_file(file_, cache_ / "models" / kept_name(request));
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "si.json", cache_ = folder_.path() / "cache";
};

TEST_F(GuideModelTest, IsTheOneThatIsNamed) {
  const EstimateOptions named{Estimate::guided, file_.string()};
  const GuideModel found = find_guide_model(named, scene(3), {});
  EXPECT_TRUE(found.model);
  EXPECT_THAT(found.identity, StartsWith("si.json sha256 "));
  EXPECT_TRUE(find_guide_model(named, scene(3, 30), {}).model);  // who names one means it
  EXPECT_THROW(find_guide_model({Estimate::guided, "none.json"}, scene(3), {}), FileError);
  EXPECT_FALSE(find_guide_model({Estimate::guided, "off"}, scene(3), cache_).model);
}

TEST_F(GuideModelTest, IsKeptForTheSceneOrThereIsNone) {
  const EstimateOptions usual;
  EXPECT_THAT(find_guide_model(usual, scene(3), {}).reason, HasSubstr("no cache"));
  EXPECT_THAT(find_guide_model(usual, scene(3), cache_).reason, HasSubstr("no fast model"));
  keep();
  EXPECT_TRUE(find_guide_model(usual, scene(3), cache_).model);
  EXPECT_TRUE(find_guide_model(usual, scene(1.5), cache_).model);
  EXPECT_FALSE(find_guide_model(usual, scene(0.5), cache_).model);  // a sixth of its pixel
  EXPECT_THAT(find_guide_model(usual, scene(3, 30), cache_).reason, HasSubstr("vertical beam"));
  EXPECT_FALSE(find_guide_model(usual, scene(3, 0, "Au"), cache_).model);
}

TEST_F(GuideModelTest, IsTrainedWhereThatPays) {
  const EstimateOptions usual;
  const double few = 1e6, many = 1e9;
  EXPECT_TRUE(trains_guide_model(usual, scene(3), cache_, many));
  EXPECT_FALSE(trains_guide_model(usual, scene(3), cache_, few));
  EXPECT_FALSE(trains_guide_model(usual, scene(3), {}, many));
  EXPECT_FALSE(trains_guide_model(usual, scene(3, 30), cache_, many));
  EXPECT_FALSE(trains_guide_model(usual, scene(0.1), cache_, many));
  EXPECT_FALSE(trains_guide_model({Estimate::guided, "off"}, scene(3), cache_, many));
  keep();
  EXPECT_FALSE(trains_guide_model(usual, scene(3), cache_, many));
}

TEST_F(GuideModelTest, PredictsWhatTheSceneShows) {
  const GuideModel model = find_guide_model({Estimate::guided, file_.string()}, scene(3), {});
  const SceneGuides guides = guides_of(scene(3), model, 1, {});
  ASSERT_EQ(guides.predicted.size(), 2u);
  EXPECT_EQ(guides.predicted[0].name, "SE");
  EXPECT_TRUE(guides.predicted[0].predicts);
  // The model is 1 / cosine, which is what the tilt of the surface says.
  const Grid<double>&predicted = guides.predicted[0].values, &tilt = guides.shape[0].values;
  double pt = 0, pp = 0, tt = 0, p = 0, t = 0;
  const auto n = static_cast<double>(tilt.size());
  for (std::size_t i = 0; i < tilt.size(); ++i) {
    p += predicted.data()[i] / n, t += tilt.data()[i] / n;
  }
  for (std::size_t i = 0; i < tilt.size(); ++i) {
    const double a = predicted.data()[i] - p, b = tilt.data()[i] - t;
    pt += a * b, pp += a * a, tt += b * b;
  }
  EXPECT_GT(pt / std::sqrt(pp * tt), 0.7);
  // Its own detector's prediction comes first; of one that it does not know none predicts.
  EXPECT_TRUE(guides.of("BSE").front().predicts);
  for (const Guide& guide : guides.of("side")) EXPECT_FALSE(guide.predicts);
  EXPECT_EQ(guides.of("side").size(), guides.of("SE").size() + 1);
}

TEST_F(GuideModelTest, ResamplesToItsPixelsAndBack) {
  const GuideModel model = find_guide_model({Estimate::guided, file_.string()}, scene(3), {});
  const Grid<double> own = guides_of(scene(3), model, 1, {}).predicted[0].values,
                     fine = guides_of(scene(1.5), model, 1, {}).predicted[0].values;
  double difference = 0, contrast = 0;
  for (int y = 2; y < 14; ++y)
    for (int x = 2; x < 14; ++x) {
      const double around = 0.25 * (fine(2 * x, 2 * y) + fine(2 * x + 1, 2 * y) +
                                    fine(2 * x, 2 * y + 1) + fine(2 * x + 1, 2 * y + 1));
      difference += std::pow(around - own(x, y), 2);
      contrast += std::pow(own(x, y) - own(15 - x, y), 2);
    }
  EXPECT_LT(difference, 0.3 * contrast);
}

}  // namespace
}  // namespace surf::workflow
