// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/image_file.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <limits>
#include <regex>

#include "io_test.h"

namespace surf::io {
namespace {

using test::content_of;
using test::image_of_f;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

class ImageFile : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == ".vti" && !has_vtk()) GTEST_SKIP() << "built without VTK";
  }
  static bool has_vtk() { return image_library_versions().find("VTK") != std::string::npos; }

  std::filesystem::path file(const std::string& stem) const {
    return folder_.path() / (stem + GetParam());
  }

  TemporaryFolder folder_;
};

void expect_same(const Image& image, const Image& expected) {
  EXPECT_EQ(image.pitch_x_nm, expected.pitch_x_nm);
  EXPECT_EQ(image.pitch_y_nm, expected.pitch_y_nm);
  EXPECT_EQ(image.origin_x_nm, expected.origin_x_nm);
  EXPECT_EQ(image.origin_y_nm, expected.origin_y_nm);
  EXPECT_EQ(image.metadata, expected.metadata);
  ASSERT_EQ(image.channels.size(), expected.channels.size());
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    EXPECT_EQ(image.channels[i].name, expected.channels[i].name);
    EXPECT_EQ(image.channels[i].unit, expected.channels[i].unit);
    EXPECT_EQ(image.channels[i].values, expected.channels[i].values) << image.channels[i].name;
  }
}

TEST_P(ImageFile, KeepsEverything) {
  const Image image = image_of_f();
  Image with_empty = image;
  with_empty.metadata["empty"] = "";  // counts as none
  write_image(file("f"), with_empty);
  expect_same(read_image(file("f")), image);
  EXPECT_EQ(test::files_in(folder_.path()), 1);
}

TEST_P(ImageFile, WritesTheSameBytesEachTime) {
  write_image(file("first"), image_of_f());
  write_image(file("second"), image_of_f());
  EXPECT_EQ(content_of(file("first")), content_of(file("second")));
}

TEST_P(ImageFile, HoldsNoSoftwareDateOrPlace) {
  write_image(file("f"), image_of_f());
  const std::string content = content_of(file("f"));
  for (const char* word : {"OpenImageIO", "Software", "DateTime", "capDate", "HostComputer",
                           "VTK 9", "semsurf-test", ".tmp"}) {
    EXPECT_THAT(content, Not(HasSubstr(word)));
  }
  EXPECT_FALSE(std::regex_search(content, std::regex("20[0-9][0-9][:-][0-9][0-9]")));
}

TEST_P(ImageFile, KeepsOnePixelAndStrangeValues) {
  Image image;
  image.channels = {{"L", "", Grid<float>(1, 1, std::numeric_limits<float>::infinity())},
                    {"R", "", Grid<float>(1, 1, std::numeric_limits<float>::denorm_min())}};
  write_image(file("one"), image);
  expect_same(read_image(file("one")), image);
  image.channels[0].values(0, 0) = std::nanf("");
  write_image(file("one"), image);
  EXPECT_TRUE(std::isnan(read_image(file("one")).channels.at(0).values(0, 0)));
}

TEST_P(ImageFile, KeepsLargeImages) {
  Image image;
  Grid<float> values(301, 517);
  for (std::size_t i = 0; i < values.size(); ++i) values.data()[i] = static_cast<float>(i) / 7;
  image.channels = {{"b", "1", values}, {"a", "1", values}};
  image.channels[1].values(300, 0) = -1;
  write_image(file("large"), image);
  expect_same(read_image(file("large")), image);
}

TEST_P(ImageFile, TruncationsAreRefused) {
  write_image(file("f"), image_of_f());
  const std::string content = content_of(file("f"));
  for (std::size_t size = 0; size < content.size() - 8; size += 61) {
    SCOPED_TRACE(size);
    test::write(file("cut"), content.substr(0, size));
    test::complaint<FileError>([&] { read_image(file("cut")); });
  }
}

std::string label(const testing::TestParamInfo<const char*>& suite) { return suite.param + 1; }

INSTANTIATE_TEST_SUITE_P(All, ImageFile, testing::Values(".exr", ".tif", ".tiff", ".vti"), label);

/// The first row of one channel, as a reader of ours has no part in it.
std::vector<float> first_scanline(const std::filesystem::path& path, int page, int channel) {
  const auto input = OIIO::ImageInput::open(path.string());
  EXPECT_TRUE(input && input->seek_subimage(page, 0));
  std::vector<float> row(static_cast<std::size_t>(input->spec().width));
  std::vector<float> all(row.size() * static_cast<std::size_t>(input->spec().nchannels));
  EXPECT_TRUE(input->read_scanline(0, 0, OIIO::TypeDesc::FLOAT, all.data()));
  for (std::size_t x = 0; x < row.size(); ++x) {
    row[x] = all[x * static_cast<std::size_t>(input->spec().nchannels) +
                 static_cast<std::size_t>(channel)];
  }
  return row;
}

std::vector<float> row_of(const Grid<float>& grid, int y) {
  const auto begin = grid.data().begin() + y * grid.width();
  return {begin, begin + grid.width()};
}

/// Two rows, so that the F's lowest row, which is not symmetric, is the file's first or last.
Image two_rows() {
  Image image;
  image.channels = {{"SE", "1", Grid<float>(3, 2)}};
  image.channels[0].values.data() = {1, 2, 3, 4, 5, 6};
  image.channels.push_back({"valid", "1", Grid<float>(3, 2, 1.0f)});
  return image;
}

TEST(ImageFileOrientation, TheFirstScanlineIsTheTopRow) {
  const TemporaryFolder folder;
  const Image image = two_rows();
  const std::vector<float> top = row_of(image.channels[0].values, 1);
  write_image(folder.path() / "a.exr", image);
  write_image(folder.path() / "a.tif", image);
  EXPECT_EQ(first_scanline(folder.path() / "a.exr", 0, 0), top);
  EXPECT_EQ(first_scanline(folder.path() / "a.tif", 0, 0), top);
  EXPECT_EQ(first_scanline(folder.path() / "a.tif", 1, 0), row_of(image.channels[1].values, 1));
}

TEST(ImageFileOrientation, ExrNamesItsChannelsAndText) {
  const TemporaryFolder folder;
  write_image(folder.path() / "a.exr", image_of_f());
  const auto input = OIIO::ImageInput::open((folder.path() / "a.exr").string());
  ASSERT_TRUE(input);
  EXPECT_THAT(input->spec().channelnames,
              testing::UnorderedElementsAre("SE", "BSE.stderr", "valid", "A_z"));
  EXPECT_EQ(input->spec().get_string_attribute("semsurf:beam.energy_ev"), "1000");
  EXPECT_EQ(input->spec().get_string_attribute("image:pitch_x_nm"), "1.25");
}

TEST(ImageFileOrientation, TiffPagesDescribeThemselves) {
  const TemporaryFolder folder;
  write_image(folder.path() / "a.tif", image_of_f());
  const auto input = OIIO::ImageInput::open((folder.path() / "a.tif").string());
  ASSERT_TRUE(input && input->seek_subimage(3, 0));
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::FLOAT);
  const std::string text(input->spec().get_string_attribute("ImageDescription"));
  EXPECT_THAT(text, HasSubstr("image:channels=A_z\tnm\n"));
  EXPECT_THAT(text, HasSubstr("image:pitch_y_nm=0.1\n"));
  EXPECT_THAT(text, HasSubstr("semsurf:semsurf.version=1.2\n"));
  EXPECT_NEAR(input->spec().get_float_attribute("XResolution"), 8e6, 1);  // per centimetre
  EXPECT_NEAR(input->spec().get_float_attribute("YResolution"), 1e8, 10);
  EXPECT_FALSE(input->seek_subimage(4, 0));
}

TEST(ImageFileOrientation, AVtiMayBeginAnywhere) {
  const TemporaryFolder folder;
  const auto path =
      test::write(folder.path() / "a.vti",
                  "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"2 3 -1 0 5 5\" "
                  "Origin=\"10 20 0\" Spacing=\"2 3 1\"><Piece Extent=\"2 3 -1 0 5 5\">"
                  "<PointData><DataArray type=\"Int16\" Name=\"a\" format=\"ascii\" "
                  "NumberOfComponents=\"2\">1 -1 2 -2 3 -3 4 -4</DataArray></PointData>"
                  "</Piece></ImageData></VTKFile>");
  const Image image = read_image(path);
  EXPECT_EQ(image.origin_x_nm, 14);
  EXPECT_EQ(image.origin_y_nm, 17);
  EXPECT_EQ(image.pitch_y_nm, 3);
  ASSERT_EQ(image.channels.size(), 2u);
  EXPECT_EQ(image.channels[1].name, "a.1");
  EXPECT_EQ(image.channels[0].values(1, 0), 2);
  EXPECT_EQ(image.channels[1].values(0, 1), -3);
}

TEST(ImageFileOrientation, VtiStandsInSpace) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.vti";
  try {
    check_image_target(path);
  } catch (const Unsupported& error) {
    GTEST_SKIP() << error.what();
  }
  Image image = two_rows();
  image.pitch_x_nm = 2;
  image.origin_y_nm = -7.5;
  write_image(path, image);
  const std::string text = content_of(path);
  EXPECT_THAT(text, HasSubstr("WholeExtent=\"0 2 0 1 0 0\" Origin=\"0 -7.5 0\" Spacing=\"2 1 1\""));
  EXPECT_THAT(text, HasSubstr("format=\"binary\""));
  EXPECT_THAT(text, Not(HasSubstr("AppendedData")));
  EXPECT_EQ(read_image(path).channels.at(0).values, image.channels[0].values);
}

TEST(ToHeightField, ScalesAndMasks) {
  Image image = image_of_f();
  image.channels[2].values(0, 0) = 0;
  image.channels[3].values(1, 0) = std::nanf("");
  const HeightField field = to_height_field(image, "A_z", 10);
  EXPECT_EQ(field.pitch_x_nm, image.pitch_x_nm);
  EXPECT_EQ(field.origin_x_nm, image.origin_x_nm);
  EXPECT_EQ(field.z_nm(4, 6), 10 * double{image.channels[3].values(4, 6)});
  EXPECT_FALSE(field.is_valid(0, 0));
  EXPECT_FALSE(field.is_valid(1, 0));
  EXPECT_TRUE(field.is_valid(2, 0));
  EXPECT_EQ(to_height_field(image_of_f(), "").z_nm(0, 0), 0.5);
  EXPECT_TRUE(to_height_field(image_of_f(), "SE").valid.empty());
  EXPECT_THAT(test::complaint<UsageError>([&] { to_height_field(image, "Z"); }),
              HasSubstr("SE, BSE.stderr, valid, A_z"));
}

}  // namespace
}  // namespace surf::io
