// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "../io_test.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

class RealScans : public test::RealFiles {
 protected:
  fs::path scan(const std::string& name) const { return root_ / "afm" / name; }
  nlohmann::json facts(const std::string& name) const {
    return nlohmann::json::parse(read_file(root_ / "truth" / (name + ".json")));
  }
  /// Heights as Gwyddion reads them, the top row first.
  std::vector<float> heights(const std::string& name) const {
    const std::string bytes = read_file(root_ / "truth" / (name + ".f32"));
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
};

/// Every pixel, to the last digit of the truth's 32 bits.
void expect_same(const HeightField& field, const std::vector<float>& truth) {
  const int w = field.z_nm.width(), h = field.z_nm.height();
  ASSERT_EQ(std::size_t(w) * std::size_t(h), truth.size());
  double largest = 0;
  for (const float z : truth) largest = std::max(largest, std::abs(double(z)));
  int wrong = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (!field.is_valid(x, y) ||
          std::abs(field.z_nm(x, y) -
                   truth[std::size_t(h - 1 - y) * std::size_t(w) + std::size_t(x)]) >
              2e-7 * largest)
        ++wrong;
  EXPECT_EQ(wrong, 0);
}

TEST_F(RealScans, EveryPixelIsThatOfAnotherReader) {
  int read = 0;
  for (const auto& entry : fs::directory_iterator(root_ / "afm")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".txt") continue;  // small ones, without a truth
    SCOPED_TRACE(name);
    const auto fact = facts(name);
    const HeightFieldFile file = read_height_field(entry.path());
    EXPECT_EQ(file.field.z_nm.width(), fact["nx"].get<int>());
    EXPECT_EQ(file.field.z_nm.height(), fact["ny"].get<int>());
    EXPECT_EQ(file.channel, fact["channel"].get<std::string>());
    EXPECT_NEAR(file.field.pitch_x_nm / fact["pixel_x_nm"].get<double>(), 1, 1e-7);
    EXPECT_NEAR(file.field.pitch_y_nm / fact["pixel_y_nm"].get<double>(), 1, 1e-7);
    EXPECT_FALSE(file.format.empty());
    expect_same(file.field, heights(name));
    ++read;
  }
  EXPECT_EQ(read, 14);
}

TEST_F(RealScans, EveryChannelIsListedInTheFilesOrder) {
  for (const char* name :
       {"AR_20211011.ibw", "AR_20211011_4ch.gwy", "CL_0deg_xcal.spm", "NanoSurf_20160301.nid",
        "Si_7x7_012.sxm", "di-1.di", "file.jpk-qi-image", "stp-1.stp"}) {
    SCOPED_TRACE(name);
    const auto channels = height_channels(scan(name));
    const auto known = facts(name)["all_channels"];
    ASSERT_EQ(channels.size(), known.size());
    for (std::size_t i = 0; i < channels.size(); ++i) {
      SCOPED_TRACE(i);
      EXPECT_EQ(channels[i].name, known[i]["title"].get<std::string>());
      if (!channels[i].is_height) continue;
      const HeightField field =
          read_height_field(scan(name), {.channel = std::to_string(i + 1)}).field;
      const auto [low, high] =
          std::minmax_element(field.z_nm.data().begin(), field.z_nm.data().end());
      const double span = known[i]["max"].get<double>() - known[i]["min"].get<double>();
      EXPECT_NEAR(*low * 1e-9, known[i]["min"].get<double>(), 1e-6 * span);
      EXPECT_NEAR(*high * 1e-9, known[i]["max"].get<double>(), 1e-6 * span);
    }
  }
}

TEST_F(RealScans, WhatIsNoHeightIsReadOnlyWithAUnit) {
  const fs::path file = scan("AR_20211011.ibw");
  const std::string said =
      test::complaint<InvalidInput>([&] { read_height_field(file, {.channel = "PhaseRetrace"}); });
  EXPECT_THAT(said, testing::HasSubstr("deg, which is no length"));
  EXPECT_THAT(said, testing::HasSubstr("HeightRetrace"));
  const HeightField field =
      read_height_field(file, {.channel = "phaseretrace", .z_unit_nm = 2}).field;
  EXPECT_NEAR(*std::max_element(field.z_nm.data().begin(), field.z_nm.data().end()),
              2 * 85.1892318725586, 1e-6);
  test::complaint<UsageError>([&] { read_height_field(file, {.channel = "Haight"}); });
}

TEST_F(RealScans, SmallTextFilesAreReadAsTheyAreMeant) {
  const auto read = [&](const char* name) { return read_height_field(scan(name)).field; };
  for (const char* name : {"gwyddion-export-english.txt", "gwyddion-export-german.txt"}) {
    const HeightField field = read(name);
    EXPECT_EQ(field.z_nm.width(), 3);
    EXPECT_NEAR(field.pitch_x_nm, 12340.0 / 3, 1e-9);
    EXPECT_NEAR(field.pitch_y_nm, 5678.9 / 4, 1e-9);
    EXPECT_DOUBLE_EQ(field.z_nm(1, 3), 1.5e9);
    EXPECT_DOUBLE_EQ(field.z_nm(2, 0), 9e9);
  }
  const HeightField phase = read("matrix-4.txt");
  EXPECT_EQ(phase.z_nm.width(), 75);
  EXPECT_EQ(phase.z_nm.height(), 305);
  EXPECT_NEAR(phase.pitch_y_nm, 369.862, 1e-9);
  EXPECT_NEAR(phase.z_nm(0, 304), -4.448661 * 29.1818, 1e-6);
  EXPECT_EQ(read("matrix-5.txt").z_nm(9, 0), 0);
  EXPECT_EQ(read("matrix-6.txt").z_nm(0, 0), 9e9);
  const HeightField one = read("xyz-1.txt"), other = read("xyz-1-different-order.txt");
  EXPECT_EQ(one.z_nm.width(), 4);
  EXPECT_EQ(one.z_nm.height(), 4);
  EXPECT_EQ(other.z_nm(1, 2), 2);  // x = 1, y = 1
  const HeightField holes = read("xyz-2.txt");
  EXPECT_FALSE(holes.is_valid(1, 3));  // x = 1, y = 0
  EXPECT_FALSE(holes.is_valid(2, 2));
  EXPECT_TRUE(holes.is_valid(2, 1));
}

TEST_F(RealScans, CutOffFilesAreRefused) {
  const test::TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(root_ / "afm")) {
    if (entry.path().extension() == ".txt" || entry.path().extension() == ".xyz") continue;
    const std::string content = read_file(entry.path());
    const fs::path cut = folder.path() / entry.path().filename();
    for (const double share : {0.001, 0.01, 0.1, 0.5, 0.9}) {
      SCOPED_TRACE(fmt::format("{} to {}", entry.path().filename().string(), share));
      test::write(cut, content.substr(0, static_cast<std::size_t>(share * double(content.size()))));
      try {
        // The first channel may be whole where others are cut off.
        const HeightFieldFile file = read_height_field(cut);
        EXPECT_GT(share, 0.1);
        validate(file.field);
      } catch (const Error& error) {
        EXPECT_THAT(error.subject(), testing::HasSubstr(cut.filename().string()));
      }
    }
  }
}

}  // namespace
}  // namespace surf::io
