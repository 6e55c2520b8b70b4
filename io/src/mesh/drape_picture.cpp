// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures that lie on surfaces, as files and as places in them.
#include <algorithm>
#include <cmath>

#include "raster/grey_picture.h"
#include "raster/image_formats.h"
#include "scene_view.h"
#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "surf/io/surface_file.h"

namespace surf::io {
namespace {

/// From the edge of pixel 0; the centre of the outermost pixels is as far as it goes, so that
/// neither smoothing nor repetition brings in the other side.
double along(double place_nm, double origin_nm, double pitch_nm, int pixels) {
  const double pixel = std::clamp((place_nm - origin_nm) / pitch_nm, 0.0, double(pixels - 1));
  return (pixel + 0.5) / pixels;
}

/// Name and place, without pixels.
Image placed(const Drape& drape) {
  Image image;
  image.placement() = drape.placement();
  image.channels.push_back({drape.name, "1", {}});
  return image;
}

}  // namespace

Drape make_drape(const Image& image, const std::string& channel) {
  const auto at = std::ranges::find(image.channels, channel, &Channel::name);
  const auto number = static_cast<std::size_t>(at - image.channels.begin());
  return {image.placement(), channel, make_grey_picture(rows_of(image), number).grey};
}

TexturePoint texture_point(const Drape& drape, const Vec3& place_nm) {
  return {along(place_nm.x, drape.origin_x_nm, drape.pitch_x_nm, drape.grey.width()),
          along(place_nm.y, drape.origin_y_nm, drape.pitch_y_nm, drape.grey.height())};
}

std::string format_drape(const std::string& file, const Drape& drape) {
  const int width = drape.grey.width();
  return png_content(file, placed(drape), width, drape.grey.height(),
                     [&](int y, std::span<unsigned char> row) {
                       for (int x = 0; x < width; ++x)
                         row[static_cast<std::size_t>(x)] = drape.grey(x, y);
                     });
}

Image to_image(const Drape& drape) {
  Image image = placed(drape);
  Grid<float>& values = image.channels.front().values;
  values = Grid<float>(drape.grey.width(), drape.grey.height());
  std::copy(drape.grey.data().begin(), drape.grey.data().end(), values.data().begin());
  return image;
}

Drape read_drape(const std::filesystem::path& path) {
  const Image image = read_image(path);
  const Channel& channel = image.channels.front();
  Drape drape{image.placement(), channel.name, Grid<std::uint8_t>(image.width(), image.height())};
  for (std::size_t i = 0; i < channel.values.size(); ++i) {
    const float value = channel.values.data()[i];
    if (!(value >= 0 && value <= 255)) {
      throw FileError(path.string(), "its values are not from 0 to 255, as those of a picture",
                      "Write the surface again with semsurf");
    }
    drape.grey.data()[i] = static_cast<std::uint8_t>(value);
  }
  return drape;
}

}  // namespace surf::io
