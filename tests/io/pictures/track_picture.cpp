// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/track_picture.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <limits>

#include "io_test.h"
#include "vtk/some_tracks.h"

namespace surf::io {
namespace {

using test::complaint;
using test::TemporaryFolder;
using testing::HasSubstr;

struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::vector<unsigned char> values;

  std::array<int, 3> at(int x, int y) const {
    const auto i = static_cast<std::size_t>((y * width + x) * channels);
    return {values[i], values[i + 1], values[i + 2]};
  }
};

Pixels draw(std::span<const Track> tracks, const TrackPictureOptions& options) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "t.png";
  write_track_picture(path, tracks, options);
  EXPECT_EQ(test::files_in(folder.path()), 1);
  auto file = OIIO::ImageInput::open(path.string());
  Pixels pixels;
  if (!file) return pixels;
  pixels.width = file->spec().width;
  pixels.height = file->spec().height;
  pixels.channels = file->spec().nchannels;
  pixels.values.resize(static_cast<std::size_t>(pixels.width * pixels.height * pixels.channels));
  file->read_image(0, 0, 0, pixels.channels, OIIO::TypeDesc::UINT8, pixels.values.data());
  return pixels;
}

/// The middle of all pixels whose colour is near this one, and their number.
struct Spot {
  double x = 0, y = 0;
  int count = 0;
};

Spot find_color(const Pixels& pixels, std::array<int, 3> color) {
  Spot spot;
  // The legend stands in the lower right corner.
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width * 6 / 10; ++x) {
      const auto found = pixels.at(x, y);
      int distance = 0;
      for (std::size_t c = 0; c < 3; ++c) distance += std::abs(found[c] - color[c]);
      if (distance > 90) continue;
      spot.x += x;
      spot.y += y;
      ++spot.count;
    }
  }
  if (spot.count > 0) spot = {spot.x / spot.count, spot.y / spot.count, spot.count};
  return spot;
}

Track line(TrackKind kind, const Vec3& from, const Vec3& to) {
  Track track;
  track.kind = kind;
  track.points_nm = {from, to};
  track.energy_ev = {10, 10};
  track.material = {0};
  return track;
}

TEST(TrackPicture, ShowsXToTheRightAndZUpInOneScale) {
  TrackPictureOptions options;
  options.width_px = options.height_px = 600;
  options.window_nm = {-10, -10, 10, 10};
  // Backscattered: level, upper left. Secondary: upright, lower left and as long.
  const std::vector<Track> tracks{line(TrackKind::bse, {-9, 0, 8}, {-5, 5, 8}),
                                  line(TrackKind::se, {-7, 0, -8}, {-7, 5, -4})};
  const Pixels pixels = draw(tracks, options);
  ASSERT_EQ(pixels.width, 600);
  ASSERT_EQ(pixels.height, 600);
  const Spot bse = find_color(pixels, {213, 94, 0});
  const Spot se = find_color(pixels, {0, 158, 115});
  ASSERT_GT(bse.count, 50);
  ASSERT_GT(se.count, 50);
  EXPECT_NEAR(bse.x, se.x, 1) << "both about x = -7";
  EXPECT_LT(bse.y, 200);
  EXPECT_GT(se.y, 350);
  EXPECT_NEAR(bse.count, se.count, 0.1 * bse.count);
}

TEST(TrackPicture, DrawsTheOutlineAndClips) {
  TrackPictureOptions options;
  options.window_nm = {-10, -10, 10, 10};
  const Pixels without = draw({}, options);
  options.outline_nm = {{Vec3{-1e12, 0, 0}, Vec3{1e12, 0, 0}}};
  const Pixels with = draw({}, options);
  int changed = 0, lowest = with.width, highest = 0;
  for (int y = 0; y < with.height; ++y) {
    for (int x = 0; x < with.width; ++x) {
      if (with.at(x, y) == without.at(x, y)) continue;
      ++changed;
      lowest = std::min(lowest, x);
      highest = std::max(highest, x);
    }
  }
  EXPECT_GT(changed, 1400) << "a line across the plot";
  EXPECT_GT(lowest, 90);
  EXPECT_LT(highest, with.width - 25);
}

TEST(TrackPicture, PicksAWindowAroundWhatIsInside) {
  auto tracks = test::random_walks(40);
  tracks[0].points_nm.front() = {0, 0, 1e7};  // a beam from far above
  const Pixels pixels = draw(tracks, {});
  EXPECT_GT(find_color(pixels, {0, 114, 178}).count, 500) << "primaries fill the picture";
}

TEST(TrackPicture, WritesEveryFormatWithoutAClock) {
  const TemporaryFolder folder;
  for (const char* name : {"a.svg", "b.svg", "a.pdf", "b.pdf", "a.PNG", "b.PNG"}) {
    write_track_picture(folder.path() / name, test::random_walks(20), {.title = "Title"});
  }
  // (Cairo numbers the SVG surfaces of a process, so that two of them differ.)
  for (const char* extension : {"pdf", "PNG"}) {
    EXPECT_TRUE(test::content_of(folder.path() / (std::string("a.") + extension)) ==
                test::content_of(folder.path() / (std::string("b.") + extension)))
        << extension;
  }
  EXPECT_THAT(test::content_of(folder.path() / "a.svg"), HasSubstr("<svg"));
  EXPECT_THAT(test::content_of(folder.path() / "a.pdf"), testing::StartsWith("%PDF"));
}

TEST(TrackPicture, RefusesWhatCannotBeDrawn) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "t.png";
  const auto tracks = test::two_tracks();
  const auto refusal = [&](const TrackPictureOptions& options) {
    return complaint<InvalidInput>([&] { write_track_picture(path, tracks, options); });
  };
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal({.width_px = 100}), HasSubstr("100 pixels"));
  EXPECT_THAT(refusal({.height_px = 30000}), HasSubstr("30000 pixels"));
  EXPECT_THAT(refusal({.outline_nm = {{Vec3{infinity, 0, 0}, Vec3{}}}}), HasSubstr("outline"));
  EXPECT_THAT(refusal({.window_nm = TrackPictureOptions::Window{0, 0, 0, 1}}), HasSubstr("window"));
  EXPECT_THAT(complaint<InvalidInput>([&] { write_track_picture(path, {}); }),
              HasSubstr("nothing to draw"));
  Track bad = tracks[0];
  bad.energy_ev.clear();
  EXPECT_THAT(complaint<InvalidInput>([&] { write_track_picture(path, std::array{bad}); }),
              HasSubstr("energies"));
  EXPECT_THAT(complaint<UsageError>([&] { write_track_picture(folder.path() / "t.jpg", tracks); }),
              HasSubstr(".png"));
  EXPECT_EQ(test::files_in(folder.path()), 0);
  check_track_picture_target(folder.path() / "new" / "t.svg");
}

}  // namespace
}  // namespace surf::io
