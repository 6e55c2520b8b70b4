// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/web_page.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io_test.h"
#include "surf/io/image_file.h"
#include "surf/mesh/height_field_mesh.h"

namespace surf::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A page as a browser would take it apart.
struct Opened {
  std::string html;
  nlohmann::json scene;

  std::string element(const std::string& id) const {
    const std::size_t name = html.find("id=\"" + id + "\"");
    EXPECT_NE(name, std::string::npos) << id;
    const std::size_t begin = html.find('>', name) + 1;
    return html.substr(begin, html.find("</script>", begin) - begin);
  }

  std::string bytes(const nlohmann::json& place) const {
    static const std::string digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string decoded;
    unsigned held = 0;
    int bits = 0;
    for (const char c : element("data" + std::to_string(place.at("data").get<int>()))) {
      if (c == '=') break;
      held = held << 6 | static_cast<unsigned>(digits.find(c));
      bits += 6;
      if (bits < 8) continue;
      bits -= 8;
      decoded += static_cast<char>(held >> bits & 0xff);
    }
    return decoded;
  }

  std::vector<std::uint32_t> words(const nlohmann::json& place) const {
    const std::size_t count = place.at("count");
    std::string planes(4 * count, '\0');
    uLongf length = planes.size();
    const std::string packed = bytes(place);
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(planes.data()), &length,
                         reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
              Z_OK);
    EXPECT_EQ(length, planes.size());
    std::vector<std::uint32_t> numbers(count);
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t plane = 0; plane < 4; ++plane)
        sum += std::uint32_t{static_cast<unsigned char>(planes[plane * count + i])} << 8 * plane;
      numbers[i] = sum;
    }
    return numbers;
  }

  std::vector<float> floats(const nlohmann::json& place) const {
    std::vector<float> values;
    for (const std::uint32_t word : words(place)) values.push_back(std::bit_cast<float>(word));
    return values;
  }
};

HeightField field_of_f() {
  HeightField field;
  const Grid<float> f = letter_f();
  field.z_nm = Grid<double>(f.width(), f.height());
  for (std::size_t i = 0; i < f.size(); ++i) field.z_nm.data()[i] = 1000.25 + double(f.data()[i]);
  field.pitch_x_nm = 2;
  field.pitch_y_nm = 0.5;
  field.origin_x_nm = -7;
  field.origin_y_nm = 3;
  return field;
}

io::WebPage page_of_f() {
  io::WebPage page;
  page.title = "F";
  page.surfaces.push_back({"letter", field_of_f(), {}, {{"instrument", "none"}}});
  return page;
}

class WebPage : public testing::Test {
 protected:
  void SetUp() override {
    try {
      io::check_web_page_target(folder_.path() / "page.html");
    } catch (const Unsupported& error) {
      GTEST_SKIP() << error.what();
    }
  }

  Opened written(const io::WebPage& page, const std::string& name = "page.html") {
    io::write_web_page(folder_.path() / name, page);
    Opened opened{content_of(folder_.path() / name), {}};
    opened.scene = nlohmann::json::parse(opened.element("scene"));
    return opened;
  }

  template <class E = InvalidInput>
  std::string refused(const io::WebPage& page) {
    const std::string said =
        complaint<E>([&] { io::write_web_page(folder_.path() / "page.html", page); });
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "page.html"));
    return said;
  }

  TemporaryFolder folder_;
};

TEST_F(WebPage, KeepsAFieldWhereItLies) {
  const Opened page = written(page_of_f());
  const auto& surface = page.scene.at("surfaces").at(0);
  EXPECT_EQ(surface.at("kind"), "grid");
  EXPECT_EQ(surface.at("size"), (std::vector{5, 7}));
  EXPECT_EQ(surface.at("pitch_nm"), (std::vector{2.0, 0.5}));
  EXPECT_EQ(surface.at("origin_nm"), (std::vector{-7.0, 3.0}));
  const double middle = surface.at("middle_nm");
  const std::vector<float> heights = page.floats(surface.at("heights"));
  const HeightField field = field_of_f();
  ASSERT_EQ(heights.size(), field.z_nm.size());
  for (std::size_t i = 0; i < heights.size();
       ++i)  // row by row, the lowest first, to float32 of the range
    EXPECT_NEAR(middle + double(heights[i]), field.z_nm.data()[i], 1e-7);
}

TEST_F(WebPage, LeavesHolesOpen) {
  io::WebPage page = page_of_f();
  auto& field = std::get<HeightField>(page.surfaces[0].shape);
  field.valid = Mask(5, 7, 1);
  field.valid(3, 2) = 0;
  field.z_nm(3, 2) = nan;
  const Opened opened = written(page);
  const std::vector<float> heights = opened.floats(opened.scene.at("surfaces").at(0).at("heights"));
  for (std::size_t i = 0; i < heights.size(); ++i)
    EXPECT_EQ(std::isnan(heights[i]), i == 2 * 5 + 3) << i;
  for (unsigned char& valid : field.valid.data()) valid = 0;
  EXPECT_THAT(refused((std::filesystem::remove(folder_.path() / "page.html"), page)),
              HasSubstr("every sample is a hole"));
}

TEST_F(WebPage, KeepsMeshesAndScalars) {
  io::WebPage page;
  TriangleMesh mesh = height_field_sheet(field_of_f());
  std::vector<float> values(mesh.vertices_nm.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i == 4 ? float(nan) : 0.1f * float(i);
  page.surfaces.push_back({"mesh", mesh, {{"SE.stderr <b>", "1", values}}, {}});
  page.scalar = "SE.stderr <b>";
  const Opened opened = written(page);
  const auto& surface = opened.scene.at("surfaces").at(0);
  EXPECT_EQ(opened.scene.at("scalar"), "SE.stderr <b>");
  const std::vector<float> planes = opened.floats(surface.at("positions"));
  ASSERT_EQ(planes.size(), 3 * mesh.vertices_nm.size());
  const auto middle = surface.at("middle_nm").get<std::array<double, 3>>();
  for (std::size_t i = 0; i < mesh.vertices_nm.size(); ++i) {
    const Vec3& vertex = mesh.vertices_nm[i];
    const std::size_t count = mesh.vertices_nm.size();
    EXPECT_NEAR(middle[0] + double(planes[i]), vertex.x, 1e-6);
    EXPECT_NEAR(middle[1] + double(planes[count + i]), vertex.y, 1e-6);
    EXPECT_NEAR(middle[2] + double(planes[2 * count + i]), vertex.z, 1e-6);
  }
  std::vector<std::uint32_t> corners;
  for (const Triangle& triangle : mesh.triangles)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  EXPECT_EQ(opened.words(surface.at("corners")), corners);
  const std::vector<float> kept = opened.floats(surface.at("scalars").at(0).at("values"));
  ASSERT_EQ(kept.size(), values.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_TRUE(i == 4 ? std::isnan(kept[i]) : kept[i] == values[i]) << i;
}

TEST_F(WebPage, KeepsPicturesInTheirOwnGreys) {
  io::WebPage page;
  page.images.push_back({"f.exr", image_of_f()});
  page.surfaces.push_back({"letter", field_of_f(), {}, {}});
  page.drape = io::WebDrape{0, "BSE.stderr"};
  const Opened opened = written(page);
  const auto& image = opened.scene.at("images").at(0);
  ASSERT_EQ(image.at("channels").size(), 3u);  // not "valid"
  EXPECT_EQ(image.at("channels").at(1).at("name"), "BSE.stderr");
  EXPECT_EQ(image.at("origin_nm").at(0), -100.0 / 3);
  EXPECT_EQ(image.at("channels").at(0).at("low"), 0.25);
  EXPECT_EQ(image.at("channels").at(0).at("high"), 1.0);
  const auto png = write(folder_.path() / "se.png", opened.bytes(image.at("channels").at(0)));
  const Image read = io::read_image(png);
  ASSERT_EQ(read.width(), 5);
  ASSERT_EQ(read.height(), 7);
  const Grid<float> f = letter_f();
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_EQ(read.channels.front().values.data()[i],
              std::round(255 * (f.data()[i] - 0.25f) / 0.75f));

  page.images[0].has_scale = false;
  page.drape.reset();
  EXPECT_FALSE(written(page).scene.at("images").at(0).contains("pitch_nm"));
}

TEST_F(WebPage, NeedsNothingElse) {
  const std::string html = written(page_of_f()).html;
  for (const char* outside : {"src=\"http", "href=\"http", "<link", "@import", "url(http"})
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  EXPECT_THAT(html,
              HasSubstr("Permission is hereby granted"));  // the licence of three.js goes along
  EXPECT_THAT(html, Not(HasSubstr("<!--semsurf:")));
}

TEST_F(WebPage, SurvivesTextThatLooksLikeHtml) {
  io::WebPage page = page_of_f();
  page.title = "</title><script>alert(1)</script>";
  page.metadata = {{"evil", "</script><script>alert(1)</script><!--"}, {"latin", "caf\xE9"}};
  page.surfaces[0].name = "<img>";
  const Opened opened = written(page);
  EXPECT_THAT(opened.html, Not(HasSubstr("<script>alert")));
  EXPECT_EQ(opened.scene.at("metadata").at("evil"), page.metadata["evil"]);
  EXPECT_EQ(opened.scene.at("surfaces").at(0).at("name"), "<img>");
}

TEST_F(WebPage, IsTheSameEveryTime) {
  EXPECT_EQ(written(page_of_f(), "a.html").html, written(page_of_f(), "b.html").html);
}

TEST_F(WebPage, IsSmallForALargeField) {
  HeightField field;
  field.z_nm = Grid<double>(512, 512);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x)
      field.z_nm(x, y) =
          10 * std::sin(0.02 * x) * std::cos(0.03 * y) + 1e-3 * ((x * 7919 + y * 104729) % 997);
  io::WebPage page;
  page.surfaces.push_back({"field", field, {}, {}});
  const io::WebPageSummary summary = io::write_web_page(folder_.path() / "page.html", page);
  EXPECT_EQ(summary.bytes, std::filesystem::file_size(folder_.path() / "page.html"));
  EXPECT_LT(summary.bytes - summary.viewer_bytes, 1'200'000u);  // 1.4 MB of base64 alone
  EXPECT_LT(summary.viewer_bytes, 900'000u);
}

TEST_F(WebPage, RefusesWhatItCannotShow) {
  EXPECT_THAT(refused({}), HasSubstr("nothing to show"));
  io::WebPage page = page_of_f();
  page.surfaces.push_back(page.surfaces[0]);
  EXPECT_THAT(refused(page), HasSubstr("used twice"));
  page = page_of_f();
  std::get<HeightField>(page.surfaces[0].shape).z_nm(1, 1) = nan;
  EXPECT_THAT(refused(page), HasSubstr("letter"));
  page = page_of_f();
  page.surfaces[0].scalars.push_back({"short", "1", {1, 2}});
  EXPECT_THAT(refused(page), HasSubstr("2 values for 35 places"));
  page.surfaces[0].scalars[0].values.assign(35, std::numeric_limits<float>::infinity());
  EXPECT_THAT(refused(page), HasSubstr("infinite"));
  page = page_of_f();
  page.scalar = "certainty";
  EXPECT_THAT(refused(page), HasSubstr("no surface has a scalar 'certainty'"));
  page = page_of_f();
  page.drape = io::WebDrape{0, "SE"};
  EXPECT_THAT(refused(page), HasSubstr("no image"));
  page = page_of_f();
  page.images.push_back({"empty", {}});
  EXPECT_THAT(refused(page), HasSubstr("empty"));
}

TEST_F(WebPage, RefusesBadTargets) {
  const io::WebPage page = page_of_f();
  EXPECT_THAT(complaint<UsageError>([&] { io::write_web_page(folder_.path() / "page.glb", page); }),
              HasSubstr("ends in .html"));
  write(folder_.path() / "file", "");
  EXPECT_THAT(complaint<FileError>(
                  [&] { io::write_web_page(folder_.path() / "file" / "page.html", page); }),
              HasSubstr("page.html"));
  EXPECT_EQ(files_in(folder_.path()), 1);
}

TEST_F(WebPage, WritesNothingWhenCancelled) {
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(io::write_web_page(folder_.path() / "page.html", page_of_f(), {{}, &cancel}),
               Interrupted);
  EXPECT_EQ(files_in(folder_.path()), 0);
}

}  // namespace
}  // namespace surf::test
