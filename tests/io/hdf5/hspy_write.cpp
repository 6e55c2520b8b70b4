// SPDX-License-Identifier: GPL-3.0-or-later
// Files of HyperSpy, read by HDF5 itself; tests/programs/check_hyperspy.py opens them in HyperSpy.
#include <gmock/gmock.h>
#include <hdf5.h>

#include <array>

#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "temporary_folder.h"

namespace surf::io {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Image two_channels() {
  Image image;
  image.pitch_x_nm = 2, image.pitch_y_nm = 3;
  image.origin_x_nm = -5;
  Grid<float> se(3, 2), bse(3, 2, 0.25F);
  for (std::size_t i = 0; i < se.size(); ++i) se.data()[i] = float(i);
  image.channels = {{"SE", "1", se}, {"BSE/top", "1", bse}};
  image.metadata = {{"beam.energy_ev", "1500"}, {"beam.tilt_deg", "7"}, {"note", "µ"}};
  return image;
}

double number(hid_t file, const char* group, const char* name) {
  double value = NAN;
  const hid_t attribute = H5Aopen_by_name(file, group, name, H5P_DEFAULT, H5P_DEFAULT);
  EXPECT_GE(attribute, 0) << group << " " << name;
  H5Aread(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  return value;
}

TEST(HspyFile, HoldsEachChannelWithItsAxesTopRowFirst) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "image.hspy";
  write_image(path, two_channels());
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  std::array<float, 6> pixels{};
  const hid_t data = H5Dopen2(file, "Experiments/SE/data", H5P_DEFAULT);
  ASSERT_GE(H5Dread(data, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, pixels.data()), 0);
  H5Dclose(data);
  EXPECT_THAT(pixels, testing::ElementsAre(3, 4, 5, 0, 1, 2));
  EXPECT_EQ(number(file, "Experiments/SE/axis-0", "scale"), 3);
  EXPECT_EQ(number(file, "Experiments/SE/axis-1", "scale"), 2);
  EXPECT_EQ(number(file, "Experiments/SE/axis-1", "size"), 3);
  const char* const sem = "Experiments/BSE_top/metadata/Acquisition_instrument/SEM";
  EXPECT_EQ(number(file, sem, "beam_energy"), 1.5);
  EXPECT_EQ(number(file, "Experiments/SE/original_metadata", "origin_x_nm"), -5);
  H5Fclose(file);
}

TEST(HspyFile, IsWrittenWholeOrNotAtAll) {
  const test::TemporaryFolder folder;
  Image image = two_channels();
  image.channels.push_back(image.channels.back());  // two of one name
  EXPECT_THROW(write_image(folder.path() / "image.hspy", image), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(HspyFile, IsNotReadAndSaysByWhat) {
  const test::TemporaryFolder folder;
  write_image(folder.path() / "image.hspy", two_channels());
  EXPECT_THAT([&] { read_image(folder.path() / "image.hspy"); },
              ThrowsMessage<UsageError>(HasSubstr("hyperspy.api.load")));
}

}  // namespace
}  // namespace surf::io
