// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/imageio.h>

#include "io_test.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

using test::complaint;
using test::files_in;
using test::image_of_f;
using test::TemporaryFolder;
using test::write;
using testing::HasSubstr;

bool has_vtk() { return image_library_versions().find("VTK") != std::string::npos; }

TEST(ImageFileErrors, UnknownExtensions) {
  const TemporaryFolder folder;
  for (const char* name : {"a.jpg", "a", "a.stl", ".exr"}) {
    const auto path = folder.path() / name;
    EXPECT_FALSE(is_image_file(path));
    EXPECT_THAT(complaint<UsageError>([&] { write_image(path, image_of_f()); }), HasSubstr(".tif"));
    complaint<UsageError>([&] { check_image_target(path); });
    complaint<UsageError>([&] { read_image(path); });
  }
  EXPECT_EQ(files_in(folder.path()), 0);
  for (const char* name : {"a.exr", "a.TIF", "a.tiff", "a.Png", "b/a.vti"}) {
    EXPECT_TRUE(is_image_file(name));
  }
}

/// A TIFF image of one strip, as a few bytes announce it.
std::string tiny_tiff(std::uint32_t width, std::uint32_t height, std::uint32_t compression,
                      std::uint32_t strip_bytes) {
  std::string text("II*\0\x08\0\0\0", 8);
  const auto add = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
  };
  const std::pair<std::uint32_t, std::uint32_t> tags[] = {
      {256, width}, {257, height}, {258, 32},     {259, compression}, {262, 1},
      {273, 200},   {277, 1},      {278, height}, {279, strip_bytes}, {339, 3}};
  add(std::size(tags), 2);
  for (const auto& [tag, value] : tags) {
    add(tag, 2);
    add(4, 2);
    add(1, 4);
    add(value, 4);
  }
  add(0, 4);
  text.resize(200 + strip_bytes, '\0');
  return text;
}

TEST(ImageFileErrors, PixelsThatTheFileCannotHoldTakeNoMemory) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "bomb.tif";
  for (const std::uint32_t compression : {1, 5, 8, 32773, 50000}) {
    write(path, tiny_tiff(30000, 30000, compression, 16));
    EXPECT_THAT(complaint<FileError>([&] { read_image(path); }), HasSubstr("cannot hold so many"))
        << compression;
  }
  write(folder.path() / "plain.tif", tiny_tiff(2, 2, 1, 16));
  EXPECT_EQ(read_image(folder.path() / "plain.tif").width(), 2);
}

TEST(ImageFileErrors, PngAndExrPixelsThatTheFileCannotHoldTakeNoMemory) {
  const TemporaryFolder folder;
  const auto png = folder.path() / "bomb.png";
  // A header that is right and no pixels.
  write(png,
        std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x75\x30\0\0\x75\x30\x08\x06\0\0\0", 29) +
            std::string("\x66\x27\xf8\xba", 4) + std::string("\0\0\0\0IDAT\x35\xaf\x06\x1e", 12) +
            std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12));
  complaint<FileError>([&] { read_image(png); });
  // The data window is 30000 pixels wide and high, and the rows are those of 5 x 7.
  const auto exr = folder.path() / "bomb.exr";
  write_image(exr, image_of_f());
  std::string content = test::content_of(exr);
  for (const char* name : {"dataWindow", "displayWindow"}) {
    const std::size_t at =
        content.find(std::string(name) + '\0' + "box2i") + std::string(name).size() + 1 + 6 + 4;
    for (int i = 8; i < 16; i += 4) content.replace(at + i, 4, std::string("\x2f\x75\0\0", 4));
  }
  write(exr, content);
  complaint<FileError>([&] { read_image(exr); });
}

TEST(ImageFileErrors, UnknownChannel) {
  const TemporaryFolder folder;
  const Image image = image_of_f();
  for (const char* name : {"a.png", "a.exr"}) {
    const auto path = folder.path() / name;
    EXPECT_THAT(complaint<UsageError>([&] { write_image(path, image, {"se"}); }),
                HasSubstr("'se'. Choose one of: SE, BSE.stderr, valid, A_z"));
    complaint<UsageError>([&] { check_image_target(path, &image, {"se"}); });
    check_image_target(path, &image, {"SE"});
  }
  EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(ImageFileErrors, TargetsThatCannotBeWritten) {
  const TemporaryFolder folder;
  write(folder.path() / "file", "");
  std::filesystem::create_directory(folder.path() / "folder.exr");
  for (const auto& target : {folder.path() / "file" / "a.exr", folder.path() / "folder.exr"}) {
    EXPECT_THAT(complaint<FileError>([&] { write_image(target, image_of_f()); }),
                HasSubstr(target.string()));
    complaint<FileError>([&] { check_image_target(target); });
  }
  EXPECT_EQ(files_in(folder.path()), 2);
  write_image(folder.path() / "new" / "a.exr", image_of_f());
  EXPECT_EQ(files_in(folder.path() / "new"), 1);
}

TEST(ImageFileErrors, ImagesThatAreNone) {
  const TemporaryFolder folder;
  const auto refuse = [&](const Image& image) {
    for (const char* name : {"a.exr", "a.tif", "a.png"}) {
      complaint<InvalidInput>([&] { write_image(folder.path() / name, image); });
    }
  };
  refuse(Image{});
  Image image = image_of_f();
  image.pitch_x_nm = 0;
  refuse(image);
  image = image_of_f();
  image.channels[1].name = "SE";
  refuse(image);
  image = image_of_f();
  image.channels[1].name = "a\tb";
  refuse(image);
  image = image_of_f();
  image.metadata["key"] = std::string("a\0b", 3);
  refuse(image);
  EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(ImageFileErrors, FilesThatAreNoImages) {
  const TemporaryFolder folder;
  for (const char* name : {"a.exr", "a.tif", "a.png", "a.vti"}) {
    const auto path = folder.path() / name;
    if (path.extension() == ".vti" && !has_vtk()) continue;
    EXPECT_THAT(complaint<FileError>([&] { read_image(path); }), HasSubstr("no such file"));
    for (const std::string content : {"", "hello", "<VTKFile type=\"ImageData\"></VTKFile>"}) {
      write(path, content);
      EXPECT_THAT(complaint<FileError>([&] { read_image(path); }), HasSubstr(path.string()));
    }
  }
  std::filesystem::create_directory(folder.path() / "b.png");
  complaint<FileError>([&] { read_image(folder.path() / "b.png"); });
}

TEST(ImageFileErrors, DamagedVti) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& image, const std::string& rest = {}) {
    const auto path = write(folder.path() / "a.vti",
                            "<VTKFile type=\"ImageData\">" + image + rest + "</VTKFile>");
    return complaint<FileError>([&] { read_image(path); });
  };
  const auto image = [](const std::string& attributes, const std::string& array) {
    return "<ImageData " + attributes + "><Piece Extent=\"0 1 0 1 0 0\"><PointData>" + array +
           "</PointData></Piece></ImageData>";
  };
  const std::string whole = "WholeExtent=\"0 1 0 1 0 0\"";
  const std::string values =
      "<DataArray type=\"Float32\" Name=\"a\" format=\"ascii\">1 2 3"
      "</DataArray>";
  EXPECT_THAT(refusal(image(whole, values)), HasSubstr("'a' has 3 values for 4 points"));
  EXPECT_THAT(refusal(image(whole, "")), HasSubstr("no values"));
  EXPECT_THAT(refusal(image("WholeExtent=\"0 1 0 1 0 4\"", values)), HasSubstr("not a picture"));
  EXPECT_THAT(refusal(image("WholeExtent=\"0 1\"", values)), HasSubstr("'0 1', where 6 numbers"));
  EXPECT_THAT(refusal(image("WholeExtent=\"0 2 0 1 0 0\"", values)), HasSubstr("pieces"));
  EXPECT_THAT(refusal(image(whole + " Direction=\"0 1 0 1 0 0 0 0 1\"", values)),
              HasSubstr("turned"));
  EXPECT_THAT(refusal(image(whole + " Spacing=\"0 1 1\"", values + values)), HasSubstr("a.vti"));
  EXPECT_THAT(refusal("<PolyData/>"), HasSubstr("type ImageData"));
  EXPECT_THAT(refusal("<ImageData>"), HasSubstr("XML is broken"));
  EXPECT_THAT(refusal("<ImageData/>", "<AppendedData encoding=\"raw\">"), HasSubstr("cut off"));
  const auto array = [](const std::string& attributes, const std::string& data) {
    return "<DataArray Name=\"a\" " + attributes + ">" + data + "</DataArray>";
  };
  EXPECT_THAT(refusal(image(whole, array("type=\"Float32\" format=\"ascii\"", "1 2 x 4"))),
              HasSubstr("not made of numbers"));
  EXPECT_THAT(refusal(image(whole, array("type=\"Float33\" format=\"binary\"", "AAAAAA=="))),
              HasSubstr("type is not known"));
  EXPECT_THAT(refusal(image(whole, array("type=\"Float32\" format=\"binary\"", "AA"))),
              HasSubstr("cut off"));
  EXPECT_THAT(refusal(image(whole, array("type=\"Float32\" format=\"appended\" offset=\"9\"", ""))),
              HasSubstr("cut off"));
}

/// A plain picture of another program's.
void write_plain(const std::filesystem::path& path, OIIO::TypeDesc type, int channels,
                 int orientation = 1) {
  OIIO::ImageSpec spec(2, 2, channels, type);
  spec.attribute("Orientation", orientation);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto output = OIIO::ImageOutput::create(path.string());
  std::vector<float> values(static_cast<std::size_t>(4 * channels));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) / 255;
  ASSERT_TRUE(output->open(path.string(), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->close());
}

TEST(PlainImages, KeepStoredNumbers) {
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "a.tif"}) {
    const auto path = folder.path() / name;
    write_plain(path, OIIO::TypeDesc::UINT8, 1);
    Image image = read_image(path);
    ASSERT_EQ(image.channels.size(), 1u);
    EXPECT_EQ(image.channels[0].name, "L");
    EXPECT_EQ(image.pitch_x_nm, 1);
    EXPECT_EQ(image.channels[0].values.data(), (std::vector<float>{2, 3, 0, 1}));
    write_plain(path, OIIO::TypeDesc::UINT16, 4);
    image = read_image(path);
    ASSERT_EQ(image.channels.size(), 4u);
    EXPECT_EQ(image.channels[0].name, "R");
    EXPECT_EQ(image.channels[3].name, "A");
    const std::vector<float> green{9 * 257, 13 * 257, 257, 5 * 257};
    EXPECT_EQ(image.channels[1].values.data(), green);
  }
}

TEST(PlainImages, ThatAreTurnedAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.tif";
  write_plain(path, OIIO::TypeDesc::UINT8, 1, 6);
  EXPECT_THAT(complaint<FileError>([&] { read_image(path); }), HasSubstr("turned"));
}

}  // namespace
}  // namespace surf::io
