// SPDX-License-Identifier: GPL-3.0-or-later
// Small files of every format, made by hand: 3 x 4 samples that count up in the order of the file.
#include "../io_test.h"
#include "environment.h"
#include "surf/io/height_field_file.h"

namespace surf::io {
namespace {

struct Small {
  const char* file;
  const char* channel;  ///< what is asked for
  const char* name;     ///< and what it is called
  double pitch_x_nm, pitch_y_nm;
  double lower_left_nm, lower_right_nm, upper_left_nm, upper_right_nm;
};

constexpr double spm_nm = 3 * 20 / 65536.0, nid_nm = 2e4 / 65536, stp_nm = 13.7 / 11,
                 park_nm = -4.5 * 1.5e-6;
constexpr Small small_scans[] = {
    {"gwy/small", "", "Height", 1000, 2000, 13.5, 16.5, 0, 3},
    {"gsf/small", "", "Height", 1000, 2000, 13.5, 16.5, 0, 3},
    {"ibw/small", "", "HeightTrace", 1000, 2000, 0, 3, 13.5, 16.5},
    {"spm/small", "", "Height", 500 / 3.0, 200, -5 * spm_nm, -3 * spm_nm, 4 * spm_nm, 6 * spm_nm},
    {"spm/wide", "", "Height", 500 / 3.0, 200, -5 * spm_nm, -3 * spm_nm, 4 * spm_nm, 6 * spm_nm},
    {"nid/small", "", "Z-Axis forward", 1e4 / 3, 5000, 0, 2 * nid_nm, 9 * nid_nm, 11 * nid_nm},
    {"sxm/small", "", "Z (Forward)", 200 / 3.0, 75, 0, 3, 13.5, 16.5},
    {"sxm/small", "2", "Z (Backward)", 200 / 3.0, 75, 3, 0, 16.5, 13.5},
    {"stp/small", "", "Topography", 200, 75, 2 * stp_nm, 0, 11 * stp_nm, 9 * stp_nm},
    {"jpk/small", "", "Height", 100, 200, 3000, 2998, 2991, 2989},
    {"jpk/park", "", "Topography", 2500 / 3.0, 1250, 0, 2 * park_nm, 9 * park_nm, 11 * park_nm},
};

TEST(SmallScans, CornersLieWhereTheyBelong) {
  for (const Small& scan : small_scans) {
    SCOPED_TRACE(scan.file);
    const HeightFieldFile read = read_height_field(
        std::filesystem::path(SEMSURF_FUZZ_CORPUS) / scan.file, {scan.channel, {}, {}, {}});
    EXPECT_EQ(read.channel, scan.name);
    const HeightField& field = read.field;
    ASSERT_EQ(field.z_nm.width(), 3);
    ASSERT_EQ(field.z_nm.height(), 4);
    EXPECT_NEAR(field.pitch_x_nm, scan.pitch_x_nm, 1e-9 * scan.pitch_x_nm);
    EXPECT_NEAR(field.pitch_y_nm, scan.pitch_y_nm, 1e-9 * scan.pitch_y_nm);
    EXPECT_NEAR(field.z_nm(0, 0), scan.lower_left_nm, 1e-5);
    EXPECT_NEAR(field.z_nm(2, 0), scan.lower_right_nm, 1e-5);
    EXPECT_NEAR(field.z_nm(0, 3), scan.upper_left_nm, 1e-5);
    EXPECT_NEAR(field.z_nm(2, 3), scan.upper_right_nm, 1e-5);
  }
}

TEST(SmallScans, AMaskOfGwyddionIsNoHole) {
  const HeightFieldFile read =
      read_height_field(std::filesystem::path(SEMSURF_FUZZ_CORPUS) / "gwy/small");
  EXPECT_TRUE(read.field.valid.empty());
  EXPECT_THAT(read.notes, testing::ElementsAre(testing::HasSubstr("mask")));
  EXPECT_EQ(read.metadata.at("Mode"), "tapping");
}

TEST(SmallScans, OtherFormatsComeThroughGwyddion) {
  const test::TemporaryFolder folder;
  const auto file = test::write(folder.path() / "a.nrrd",
                                "NRRD0004\ntype: float\ndimension: 2\nsizes: 3 4\nspacings: 2 3\n"
                                "units: \"um\" \"um\"\nsample units: \"nm\"\nencoding: ascii\n\n"
                                "0 1 2\n3 4 5\n6 7 8\n9 10 11\n");
  HeightFieldFile read;
  try {
    read = read_height_field(file);
  } catch (const FileError& error) {
    if (std::string(error.remedy()).find("Install Gwyddion") == std::string::npos) throw;
    GTEST_SKIP() << "Gwyddion is not installed: formats that only it knows are not tested";
  }
  EXPECT_EQ(read.format, "read by Gwyddion");
  EXPECT_EQ(read.field.z_nm.width(), 3);
  EXPECT_EQ(read.field.z_nm.height(), 4);
  EXPECT_NEAR(read.field.pitch_y_nm, 3000, 1e-6);
  EXPECT_NEAR(read.field.z_nm(0, 3), 0, 1e-9);
  EXPECT_NEAR(read.field.z_nm(2, 0), 11, 1e-9);
}

/// A program of that name in a folder of its own, which is all of the search path but /bin and
/// /usr/bin.
class FakeGwyddion : public testing::Test {
 protected:
  void install(const std::string& script) {
    const auto file = test::write(folder_.path() / "gwyddion", "#!/bin/sh\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  std::filesystem::path scan(const std::string& name) {
    return test::write(folder_.path() / name, "?\x01 no mark");
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.path().string() + ":/bin:/usr/bin";
  const test::Environment environment_{{"PATH", path_.c_str()}};
};

TEST_F(FakeGwyddion, IsAskedOnceForAllChannels) {
  const std::string counted = (folder_.path() / "runs").string();
  install("echo run >> '" + counted +
          "'\nfor word; do case $word in --convert-to-gwy=*) out=${word#*=};; esac; done\ncp '" +
          SEMSURF_FUZZ_CORPUS "/gwy/small' \"$out\"\n");
  const HeightFile file(scan("a.mi"));
  ASSERT_FALSE(file.channels().empty());
  EXPECT_EQ(file.read().format, "read by Gwyddion");
  EXPECT_NEAR(file.read({"1", {}, {}, {}}).field.z_nm(0, 0), 13.5, 1e-5);
  EXPECT_EQ(test::content_of(counted), "run\n");
}

TEST_F(FakeGwyddion, MayNotKnowTheFileEither) {
  install("exit 1\n");
  const auto file = scan("a.mi");
  EXPECT_THAT(test::complaint<UnknownScan>([&] { HeightFile{file}; }),
              testing::HasSubstr("neither semsurf nor Gwyddion"));
}

TEST_F(FakeGwyddion, IsNamedWhereItIsMissing) {
  const test::Environment nowhere{{"PATH", folder_.path().c_str()}};
  const auto file = scan("a.h5-jpk");
  EXPECT_THAT(test::complaint<UnknownScan>([&] { HeightFile{file}; }),
              testing::HasSubstr("apt-get install gwyddion"));
}

TEST(SmallScans, NamesOfInstruments) {
  for (const char* name : {"a.mi", "a.SDF", "b/a.h5-jpk", "a.x3p", "a.stp", "a.asd"})
    EXPECT_TRUE(has_scan_name(name)) << name;
  for (const char* name : {"a.stl", "a.pdf", "a.tif", "mi", "a.txt", "a"})
    EXPECT_FALSE(has_scan_name(name)) << name;
}

}  // namespace
}  // namespace surf::io
