// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "surf/core/error.h"
#include "surf/core/image.h"
#include "temporary_folder.h"

namespace surf::test {

inline std::filesystem::path write(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::ptrdiff_t files_in(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

/// Files that are not part of the repository, under `root_`; skips where they are not there.
class RealFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("SEMSURF_TEST_DATA");
    if (!folder || !std::filesystem::exists(folder))
      GTEST_SKIP() << "SEMSURF_TEST_DATA names no folder: real files are not tested";
    root_ = folder;
  }

  std::filesystem::path root_;
};

/// What the exception of type E that `work` throws says; empty (and a failure) if it throws none.
template <class E, class Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const E& error) {
    EXPECT_FALSE(error.reason().empty());
    EXPECT_FALSE(error.remedy().empty());
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another kind of exception: " << error.what();
    return {};
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

/// 5 x 7 pixels with an "F" that no flip or transposition leaves as it is: strokes are 1, the
/// ground is 0.25, and the pixel left below the F is 0.5.
inline Grid<float> letter_f() {
  const char* const rows[7] = {".....", ".###.", ".#...", ".##..", ".#...", ".#...", "o...."};
  Grid<float> grid(5, 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 5; ++x) {
      const char c = rows[6 - y][x];
      grid(x, y) = c == '#' ? 1.0f : c == 'o' ? 0.5f : 0.25f;
    }
  }
  return grid;
}

/// The F as an image of three channels whose order is not that of the alphabet, placed unevenly.
inline Image image_of_f() {
  Image image;
  image.pitch_x_nm = 1.25;
  image.pitch_y_nm = 0.1;
  image.origin_x_nm = -100.0 / 3;
  image.origin_y_nm = 1e-7;
  image.metadata = {{"semsurf.version", "1.2"},
                    {"beam.energy_ev", "1000"},
                    {"title", "a=b \\ \"c\" <d> & \xC3\xA9\nsecond line"}};
  Grid<float> twice = letter_f();
  for (float& value : twice.data()) value = -2 * value + 1e-3f;
  image.channels = {{"SE", "1", letter_f()},
                    {"BSE.stderr", "1", twice},
                    {"valid", "", Grid<float>(5, 7, 1.0f)},
                    {"A_z", "nm", twice}};
  return image;
}

}  // namespace surf::test
