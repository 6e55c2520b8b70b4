// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/describe_file.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/shapes.h"
#include "surf/workflow/version.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

nlohmann::json described(const std::filesystem::path& path, const io::MeshUnit& unit = {}) {
  return nlohmann::json::parse(describe_file(path, unit));
}

class DescribeFile : public testing::Test {
 protected:
  std::filesystem::path in(const char* name) const { return folder_.path() / name; }
  test::TemporaryFolder folder_;
};

TEST_F(DescribeFile, MeshesInTheirUnit) {
  io::write_mesh(in("box.obj"), make_box({0, 0, 0}, {2, 3, 4}));
  const auto json = described(in("box.obj"), io::MeshUnit(1000.0, true));
  EXPECT_EQ(json["kind"], "mesh");
  EXPECT_EQ(json["triangles"], 12);
  EXPECT_EQ(json["closed"], true);
  EXPECT_NEAR(json["volume_nm3"].get<double>(), 24e9, 1);
  EXPECT_NEAR(json["area_nm2"].get<double>(), 52e6, 1e-3);
  EXPECT_TRUE(json["faults"].empty());
}

TEST_F(DescribeFile, HeightsWithTheirHoles) {
  HeightField field{{2, 3, 0, 0}, Grid<double>(4, 2, 5.0)};
  field.z_nm(1, 1) = 9;
  io::write_height_field(in("scan.gsf"), field);
  const auto json = described(in("scan.gsf"));
  EXPECT_EQ(json["kind"], "heights");
  EXPECT_EQ(json["width"], 4);
  EXPECT_NEAR(json["pitch_y_nm"].get<double>(), 3, 1e-6);
  EXPECT_NEAR(json["channels"][0]["highest_nm"].get<double>(), 9, 1e-5);
  EXPECT_NEAR(json["channels"][0]["mean_nm"].get<double>(), 5.5, 1e-5);
  EXPECT_EQ(json["channels"][0]["holes"], 0);
}

TEST_F(DescribeFile, ImagesWithHowTheyWereMade) {
  SimulateJob job = small_job();
  job.outputs = {in("image.exr")};
  run(job);
  const auto json = described(in("image.exr"));
  EXPECT_EQ(json["kind"], "image");
  EXPECT_EQ(json["width"], 12);
  EXPECT_EQ(json["channels"][0]["name"], "SE");
  EXPECT_EQ(json["channels"][0]["not_finite"], 0);
  EXPECT_EQ(json["metadata"]["semsurf.version"], version());
}

TEST_F(DescribeFile, ScenesAsTheyAreResolved) {
  io::write_text(
      in("scene.toml"),
      "title = \"flat\"\n[beam]\nenergy = \"1keV\"\n[scan]\nsize = \"8x6\"\n"
      "pixel_size = \"2nm\"\n[simulation]\nelectrons = 7\n[substrate]\nmaterial = \"Si\"\n");
  const auto json = described(in("scene.toml"));
  EXPECT_EQ(json["kind"], "scene");
  EXPECT_EQ(json["title"], "flat");
  EXPECT_EQ(json["electrons"], 7);
  EXPECT_EQ(json["width"], 8);
  EXPECT_EQ(json["substrate"]["material"], "Si");
  EXPECT_EQ(json["metadata"]["beam.energy_ev"], "1000");
}

TEST_F(DescribeFile, WhatCannotBeReadIsAnError) {
  EXPECT_THROW(describe_file(in("nowhere.exr")), Error);
  io::write_text(in("words.bin"), "no such thing");
  EXPECT_THROW(describe_file(in("words.bin")), Error);
}

TEST(VersionJson, NamesTheLibrariesAndTheInstructionSet) {
  const auto json = nlohmann::json::parse(version_json());
  EXPECT_EQ(json["semsurf"], version());
  EXPECT_FALSE(json["libraries"]["Embree"].get<std::string>().empty());
  EXPECT_FALSE(json["instruction_set"].get<std::string>().empty());
}

}  // namespace
}  // namespace surf::workflow
