// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sem_file.h"

#include <fmt/format.h>

#include "../io_test.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "tiff_maker.h"

namespace surf::io {
namespace {

using test::complaint;
using test::TiffMaker;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// 4 x 4 pixels whose numbers are 16 * (row of the file) + column, so that turned or mirrored ones
/// show.
constexpr int side = 4;
std::string numbered() {
  std::string pixels;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) pixels += static_cast<char>(16 * row + column);
  return pixels;
}
TiffMaker picture(bool low_byte_first = true) { return {side, side, numbered(), low_byte_first}; }

class SemFileTest : public testing::Test {
 protected:
  SemFile read(const TiffMaker& tiff, const SemReadOptions& options = {}) {
    return read_sem_image(test::write(folder_.path() / "image.tif", tiff.file()), options);
  }
  void beside(const std::string& name, const std::string& text) {
    test::write(folder_.path() / name, text);
  }
  std::filesystem::path path() const { return folder_.path() / "image.tif"; }

  test::TemporaryFolder folder_;
};

/// Without its lowest row.
void expect_upper_rows(const PlacedImage& image) {
  ASSERT_EQ(image.values.width(), 4);
  ASSERT_EQ(image.values.height(), 3);
  EXPECT_EQ(image.values(0, 0), 32);  // row 2 of the file is the lowest that is left
  EXPECT_EQ(image.values(3, 2), 3);
  EXPECT_EQ(image.origin_x_nm, 0);
  EXPECT_EQ(image.origin_y_nm, 0);
}

const std::string fei_text =
    "[Beam]\r\nHV=2000\r\nBeam=EBeam\r\nScan=EScan\r\n[EBeam]\r\nWD=0.0097\r\n[Scan]\r\nPixelWidth="
    "7.5e-009\r\n"
    "PixelHeight=8e-009\r\n[Stage]\r\nStageT=0.5\r\n[System]\r\nSystemType=Teneo\r\n[Image]"
    "\r\nResolutionX=4\r\n"
    "ResolutionY=3\r\n[Detectors]\r\nName=ETD\r\n";

TEST_F(SemFileTest, ReadsThermoFisher) {
  for (const bool low_byte_first : {true, false}) {
    TiffMaker tiff = picture(low_byte_first);
    tiff.text(34682, fei_text);
    const SemFile file = read(tiff);
    EXPECT_EQ(file.format, "Thermo/FEI");
    EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 7.5);
    EXPECT_DOUBLE_EQ(file.image.pitch_y_nm, 8);
    EXPECT_EQ(file.energy_ev, 2000);
    EXPECT_DOUBLE_EQ(file.working_distance_nm.value(), 9.7e6);
    EXPECT_NEAR(file.tilt_deg.value(), 28.6479, 1e-4);
    EXPECT_EQ(file.detector, "ETD");
    EXPECT_EQ(file.instrument, "Teneo");
    EXPECT_EQ(file.bits, 8);
    EXPECT_EQ(file.databar_rows, 1);
    EXPECT_THAT(file.notes, ElementsAre(HasSubstr("the databar, the lowest 1 rows")));
    EXPECT_EQ(file.metadata.at("Image.ResolutionY"), "3");
    expect_upper_rows(file.image);
  }
}

TEST_F(SemFileTest, KnowsNoTiltBelowZeroThatIsZero) {
  TiffMaker tiff = picture();
  std::string text = fei_text;
  text.replace(text.find("StageT=0.5"), 10, "StageT=-0.0");
  tiff.text(34682, text);
  EXPECT_EQ(fmt::format("{}", read(tiff).tilt_deg.value()), "0");
}

TEST_F(SemFileTest, KeepsTheDatabarWhereItIsWanted) {
  TiffMaker tiff = picture();
  tiff.text(34682, fei_text);
  SemReadOptions options;
  options.keep_databar = true;
  const SemFile file = read(tiff, options);
  EXPECT_EQ(file.image.values.height(), 4);
  EXPECT_EQ(file.image.values(0, 0), 48);
  EXPECT_EQ(file.databar_rows, 1);
}

std::string zeiss_text(const std::string& pixel) {
  return "0\r\n0\r\n0\r\n5.824988e-009\r\n5.0e+004\r\nAP_WD\r\nWD =  3.9 mm\r\n" + pixel +
         "AP_ACTUALKV\r\nEHT =  5.00 kV\r\nDP_DETECTOR_CHANNEL\r\nSignal A = "
         "InLens\r\nAP_STAGE_AT_T\r\n"
         "Stage at T =   12.5 \xb0\r\nAP_DATE\r\nDate :25 Sep 2018\r\nSV_SERIAL_NUMBER\r\nSerial "
         "No. = ULTRA 55\r\n";
}

TEST_F(SemFileTest, ReadsZeissWhosePixelSizeMayBeTheScreens) {
  TiffMaker tiff = picture();
  tiff.text(34118, zeiss_text("AP_PIXEL_SIZE\r\nPixel Size = 5.825 nm\r\n"));
  const SemFile file = read(tiff);
  EXPECT_EQ(file.format, "Zeiss SmartSEM");
  EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 5.824988 * 1024 / 4);
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("is for 1024 columns")));
  EXPECT_EQ(file.energy_ev, 5000);
  EXPECT_DOUBLE_EQ(file.working_distance_nm.value(), 3.9e6);
  EXPECT_EQ(file.tilt_deg, 12.5);
  EXPECT_EQ(file.detector, "InLens");
  EXPECT_EQ(file.metadata.at("AP_DATE"), "25 Sep 2018");
  EXPECT_EQ(file.image.values.height(), 4);
}

TEST_F(SemFileTest, BelievesZeissWhereItSpeaksOfTheImage) {
  TiffMaker tiff = picture();
  tiff.text(34118, zeiss_text("AP_IMAGE_PIXEL_SIZE\r\nImage Pixel Size = 1.491 \xb5m\r\n"));
  const SemFile file = read(tiff);
  EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 5.824988 * 1024 / 4);  // the same, with more digits
  EXPECT_THAT(file.notes, IsEmpty());
  TiffMaker other = picture();
  other.text(34118, zeiss_text("AP_IMAGE_PIXEL_SIZE\r\nImage Pixel Size = 700.0 pm\r\n"));
  EXPECT_DOUBLE_EQ(read(other).image.pitch_x_nm, 0.7);
}

std::string tescan_block(const TiffMaker& tiff, unsigned kind, const std::string& data) {
  return tiff.number(static_cast<unsigned>(data.size()) + 2, 4) + tiff.number(kind, 2) + data;
}

TEST_F(SemFileTest, ReadsTescan) {
  TiffMaker tiff = picture();
  const std::string picture_block = "\xff\xd8=\nPixelSizeX=3\n";  // noise that is no text
  const std::string main =
      std::string(
          "Device=MIRA3\r\nImageStripSize=1\r\nPixelSizeX=2.5e-9\r\nPixelSizeY=2.5e-9\r\n") +
      '\0';
  const std::string sem =
      std::string("Detector=SE\r\nHV=10.0000e3\r\nStageTilt=3.0\r\nWD=13.250e-3\r\n") + '\0';
  tiff.bytes(50431, tescan_block(tiff, 1, picture_block) + tescan_block(tiff, 2, main) +
                        tescan_block(tiff, 3, sem));
  const SemFile file = read(tiff);
  EXPECT_EQ(file.format, "TESCAN");
  EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 2.5);
  EXPECT_EQ(file.energy_ev, 10000);
  EXPECT_DOUBLE_EQ(file.working_distance_nm.value(), 13.25e6);
  EXPECT_EQ(file.tilt_deg, 3);
  EXPECT_EQ(file.instrument, "MIRA3");
  expect_upper_rows(file.image);
}

TEST_F(SemFileTest, ReadsTescansTextBesideTheImage) {
  beside("image-tif.hdr", "[MAIN]\r\nDevice=VEGA\r\nPixelSizeX=4e-9\r\n[SEM]\r\nHV=30000\r\n");
  const SemFile file = read(picture());
  EXPECT_EQ(file.format, "TESCAN");
  EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 4);
  EXPECT_EQ(file.energy_ev, 30000);
}

TEST_F(SemFileTest, ReadsJeolsTextBesideTheImage) {
  beside("image.txt",
         "$CM_SIGNAL SEI\r\n$CM_ACCEL_VOLT 1.00\r\n$$SM_WD 2.77\r\n$CM_FORMAT JEOL-SEM\r\n"
         "$CM_INSTRUMENT 7600F\r\n$$SM_MICRON_BAR 50\r\n$$SM_MICRON_MARKER 100nm\r\n$CM_FULL_SIZE "
         "4 3\r\n");
  const SemFile file = read(picture());
  EXPECT_EQ(file.format, "JEOL");
  EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 2);
  EXPECT_EQ(file.energy_ev, 1000);
  EXPECT_DOUBLE_EQ(file.working_distance_nm.value(), 2.77e6);
  EXPECT_EQ(file.detector, "SEI");
  EXPECT_THAT(file.notes, testing::Contains(HasSubstr("may be 1.0 % off")));
  expect_upper_rows(file.image);
}

std::string utf16(const std::u16string& text, bool low_byte_first) {
  std::string bytes = low_byte_first ? "\xff\xfe" : "\xfe\xff";
  for (const char16_t c : text) {
    const char low = static_cast<char>(c & 0xff), high = static_cast<char>(c >> 8);
    bytes += low_byte_first ? low : high;
    bytes += low_byte_first ? high : low;
  }
  return bytes;
}

TEST_F(SemFileTest, ReadsHitachisTextInUtf16) {
  for (const bool low_byte_first : {true, false}) {
    beside("image.txt",
           utf16(u"[SemImageFile]\r\nInstructName=TM4000\r\nImageName=花粉\r\nDataSize=4x3\r\n"
                 u"PixelSize=82.68229\r\nSignalName=BSE\r\nAcceleratingVoltage=15000 Volt\r\n"
                 u"WorkingDistance=7920.5 um\r\nStagePositionT=1.5\r\n",
                 low_byte_first));
    const SemFile file = read(picture());
    EXPECT_EQ(file.format, "Hitachi");
    EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 82.68229);
    EXPECT_EQ(file.energy_ev, 15000);
    EXPECT_DOUBLE_EQ(file.working_distance_nm.value(), 7.9205e6);
    EXPECT_EQ(file.detector, "BSE");
    EXPECT_EQ(file.metadata.at("ImageName"), "花粉");
    expect_upper_rows(file.image);
  }
}

TEST_F(SemFileTest, ReadsWhatHitachiRepeatsInTheImage) {
  TiffMaker tiff = picture();
  tiff.bytes(
      40092,
      utf16(u"PixelSize=82.5\r\nCondition=Vacc=15.0kV Mag=x1.20k WD=7.9mm LensMode=3\r\n", true)
          .substr(2));
  const SemFile file = read(tiff);
  EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 82.5);
  EXPECT_EQ(file.energy_ev, 15000);
  EXPECT_DOUBLE_EQ(file.working_distance_nm.value(), 7.9e6);
}

TEST_F(SemFileTest, IsNotTakenForHeightsUnlessSomebodySaysHowHighAGreyLevelIs) {
  TiffMaker tiff = picture();
  test::write(path(), tiff.file());
  EXPECT_NO_THROW(read_height_field(path()));  // a plain picture may hold heights
  tiff.text(34118, zeiss_text("AP_PIXEL_SIZE\r\nPixel Size = 5.825 nm\r\n"));
  test::write(path(), tiff.file());
  EXPECT_THAT(
      complaint<InvalidInput>([&] { read_height_field(path()); }),
      testing::AllOf(
          HasSubstr(
              "image.tif: it is an SEM image (Zeiss SmartSEM), and its grey levels are no heights"),
          HasSubstr("semsurf noise sem"), HasSubstr("scan.height_unit")));
  HeightReadOptions options;
  options.z_unit_nm = 0.5;
  EXPECT_EQ(read_height_field(path(), options).field.z_nm(0, 0), 24);  // 48 in the lowest row
}

TEST_F(SemFileTest, ReadsImageJAndOme) {
  TiffMaker imagej = picture();
  imagej.text(270, "ImageJ=1.53t\nunit=nm\n");
  imagej.ratio(282, 1, 5), imagej.ratio(283, 1, 6);
  const SemFile file = read(imagej);
  EXPECT_DOUBLE_EQ(file.image.pitch_x_nm, 5);
  EXPECT_DOUBLE_EQ(file.image.pitch_y_nm, 6);
  TiffMaker ome = picture();
  ome.text(270,
           "<?xml version=\"1.0\"?><OME><Pixels PhysicalSizeX=\"0.002\" PhysicalSizeY=\"3\" "
           "PhysicalSizeYUnit=\"nm\"/></OME>");
  EXPECT_DOUBLE_EQ(read(ome).image.pitch_x_nm, 2);
  EXPECT_DOUBLE_EQ(read(ome).image.pitch_y_nm, 3);
}

TEST_F(SemFileTest, AsksForAPixelSizeThatNobodySays) {
  TiffMaker dots = picture();
  dots.ratio(282, 96, 1), dots.ratio(283, 96, 1);  // of a screen, not of the specimen
  EXPECT_THAT(complaint<UsageError>([&] { read(dots); }), HasSubstr("`sem_pixel_size=2nm`"));
  SemReadOptions options;
  options.pixel_x_nm = 3;
  EXPECT_EQ(read(dots, options).image.pitch_x_nm, 3);
  EXPECT_EQ(read(dots, options).image.pitch_y_nm, 3);
  EXPECT_EQ(read(dots, options).pixel_from, "given");
  options.pixel_x_nm = 0;
  EXPECT_THAT(complaint<UsageError>([&] { read(dots, options); }), HasSubstr("above 0"));
}

TEST_F(SemFileTest, TakesTheGivenPixelSizeAndSaysSo) {
  TiffMaker tiff = picture();
  tiff.text(34682, fei_text);
  SemReadOptions options;
  options.pixel_x_nm = 7, options.pixel_y_nm = 7.1;
  const SemFile file = read(tiff, options);
  EXPECT_EQ(file.image.pitch_x_nm, 7);
  EXPECT_EQ(file.image.pitch_y_nm, 7.1);
  EXPECT_THAT(file.notes, testing::Contains(HasSubstr("7 nm, goes before the file's own, 7.5 nm")));
}

TEST_F(SemFileTest, TakesImpossibleNumbersForNotSaid) {
  for (const char* pixel : {"-1e-9", "0", "nan", "1e400", "inf", "", "wide"}) {
    SCOPED_TRACE(pixel);
    TiffMaker tiff = picture();
    tiff.text(34682, fmt::format("[Beam]\nHV=-5\n[Scan]\nPixelWidth={}\n[Image]\nResolutionY=-7\n",
                                 pixel));
    EXPECT_THAT(complaint<UsageError>([&] { read(tiff); }), HasSubstr("Thermo/FEI wrote"));
    SemReadOptions options;
    options.pixel_x_nm = 2;
    const SemFile file = read(tiff, options);
    EXPECT_FALSE(file.energy_ev);
    EXPECT_EQ(file.databar_rows, 0);
  }
}

TEST_F(SemFileTest, ReadsNumbersBeforeTheirPalette) {
  TiffMaker tiff = picture();
  // Bent at both ends, and 17 is for annotations.
  tiff.palette([](int i, int part) {
    return i == 17 ? (part == 0 ? 65535 : 0) : i < 3 ? 0 : 257 * i;
  });
  SemReadOptions options;
  options.pixel_x_nm = 1;
  const SemFile file = read(tiff, options);
  EXPECT_EQ(file.image.values(2, 3), 2);
  EXPECT_EQ(file.image.values(3, 0), 51);
  ASSERT_FALSE(file.image.valid.empty());
  EXPECT_FALSE(file.image.is_valid(1, 2));
  EXPECT_TRUE(file.image.is_valid(2, 2));
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("1 pixels in colour")));
}

Image colours(double green) {
  Image image;
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, "1", Grid<float>(5, 4, 9.0f)});
  for (std::size_t i = 0; i < 20; ++i)
    for (Channel& c : image.channels) c.values.data()[i] = static_cast<float>(i);
  image.channels[1].values(2, 1) = static_cast<float>(green);
  return image;
}

TEST_F(SemFileTest, TakesGreyPicturesInRgbAndRefusesColour) {
  const auto exr = folder_.path() / "image.exr";
  SemReadOptions options;
  options.pixel_x_nm = 1;
  write_image(exr, colours(7));
  EXPECT_TRUE(read_sem_image(exr, options).image.valid.empty());
  write_image(exr, colours(50));
  const SemFile file = read_sem_image(exr, options);
  EXPECT_FALSE(file.image.is_valid(2, 1));
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("1 pixels in colour")));
  Image all = colours(7);
  for (float& value : all.channels[1].values.data()) value += 3;
  write_image(exr, all);
  EXPECT_THAT(complaint<InvalidInput>([&] { read_sem_image(exr, options); }),
              HasSubstr("100 % of it is in colour"));
}

TEST_F(SemFileTest, ReadsSemsurfsOwnImagesWhereTheyLie) {
  Image image;
  image.channels = {{"SE", "1", Grid<float>(5, 4, 0.5f)},
                    {"BSE", "1", Grid<float>(5, 4, 0.25f)},
                    {"valid", "1", Grid<float>(5, 4, 1.0f)}};
  image.channels[2].values(4, 0) = 0;
  image.pitch_x_nm = image.pitch_y_nm = 2.5;
  image.origin_x_nm = -10, image.origin_y_nm = 7;
  image.metadata = {{"semsurf.version", "1"}, {"beam.energy_ev", "800"}};
  for (const char* name : {"own.tif", "own.exr", "own.vti"}) {
    const auto path = folder_.path() / name;
    try {
      write_image(path, image);
    } catch (const Unsupported&) {
      continue;
    }
    SCOPED_TRACE(name);
    const SemFile file = read_sem_image(path);
    EXPECT_EQ(file.format, "semsurf");
    EXPECT_EQ(file.channel, "SE");
    EXPECT_EQ(file.bits, 0);
    EXPECT_EQ(file.image.pitch_x_nm, 2.5);
    EXPECT_EQ(file.image.origin_x_nm, -10);
    EXPECT_EQ(file.image.origin_y_nm, 7);
    EXPECT_EQ(file.energy_ev, 800);
    EXPECT_FALSE(file.image.is_valid(4, 0));
    SemReadOptions bse;
    bse.channel = "BSE";
    EXPECT_EQ(read_sem_image(path, bse).image.values(0, 0), 0.25);
    bse.channel = "XE";
    EXPECT_THAT(complaint<UsageError>([&] { read_sem_image(path, bse); }),
                HasSubstr("SE, BSE, valid"));
  }
}

TEST_F(SemFileTest, RefusesWhatIsCutOff) {
  TiffMaker tiff = picture();
  tiff.palette([](int i, int) { return 257 * i; });
  tiff.text(34682, fei_text);
  const std::string whole = tiff.file();
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    SCOPED_TRACE(size);
    const auto path = test::write(folder_.path() / "image.tif", whole.substr(0, size));
    EXPECT_THROW(read_sem_image(path), FileError);
    EXPECT_NO_THROW(is_sem_image_file(path));
  }
}

TEST_F(SemFileTest, KnowsMakersByTheirMarks) {
  EXPECT_FALSE(is_sem_image_file(test::write(path(), picture().file())));
  beside("image.txt", "$CM_FORMAT JEOL-SEM\n");
  EXPECT_TRUE(is_sem_image_file(path()));
  EXPECT_FALSE(is_sem_image_file(folder_.path() / "image.txt"));
  EXPECT_FALSE(is_sem_image_file(folder_.path() / "missing.tif"));
}

}  // namespace
}  // namespace surf::io
