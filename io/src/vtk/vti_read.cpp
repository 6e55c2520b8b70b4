// SPDX-License-Identifier: GPL-3.0-or-later
// Reads VTK's image files, without VTK: its own reader crashes on damaged files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "raster/image_formats.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "vtk_xml.h"

namespace surf::io {
namespace {

using Element = VtkXml::Element;

struct Extent {
  int width = 0;
  int height = 0;
  double first_x = 0;  // index of the first point
  double first_y = 0;
};

Extent read_extent(const Element& image) {
  const std::vector<double> e = image.numbers("WholeExtent", std::vector<double>(6));
  const double width = e[1] - e[0] + 1, height = e[3] - e[2] + 1;
  const bool is_whole = std::all_of(
      e.begin(), e.end(), [](double v) { return v == std::floor(v) && std::abs(v) < 1e9; });
  if (!is_whole || width < 1 || height < 1 || e[5] != e[4] || width > 1e9 || height > 1e9) {
    image.fail(
        fmt::format("{} x {} x {} points are not a picture", width, height, e[5] - e[4] + 1));
  }
  return {static_cast<int>(width), static_cast<int>(height), e[0], e[2]};
}

void check_direction(const Element& image) {
  const std::vector<double> level{1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (image.numbers("Direction", level) != level) {
    image.fail("its axes are turned; only an image that lies along x and y can be read");
  }
}

Element only_piece(const Element& image) {
  const std::vector<Element> pieces = image.children("Piece");
  if (pieces.size() != 1 || pieces[0].attribute("Extent") != image.attribute("WholeExtent")) {
    image.fail(fmt::format("it is in {} pieces, where one with all points belongs", pieces.size()));
  }
  return pieces[0];
}

void append_array(const VtkArray& array, const Element& owner, const Extent& extent, Image& image) {
  const auto points = std::size_t(extent.width) * std::size_t(extent.height);
  if (array.tuples() != points) {
    owner.fail(fmt::format("the array '{}' has {} values for {} points", array.name, array.tuples(),
                           points));
  }
  const std::string name = array.name.empty() ? "L" : array.name;
  for (std::size_t c = 0; c < array.components; ++c) {
    Channel channel{array.components == 1 ? name : fmt::format("{}.{}", name, c), "1",
                    Grid<float>(extent.width, extent.height)};
    for (std::size_t i = 0; i < points; ++i) {
      channel.values.data()[i] = static_cast<float>(array.values[i * array.components + c]);
    }
    image.channels.push_back(std::move(channel));
  }
}

Attributes text_fields(const Element& image) {
  Attributes attributes;
  const auto fields = image.child("FieldData");
  if (!fields) return attributes;
  for (const VtkArray& array : fields->arrays()) {
    if (array.is_text && array.texts.size() == 1) attributes[array.name] = array.texts[0];
  }
  return attributes;
}

}  // namespace

Image read_vti(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string content = read_file(path);
  const VtkXml xml(file, content, "ImageData");
  const Element data = xml.data();
  const Extent extent = read_extent(data);
  check_direction(data);
  const std::vector<double> origin = data.numbers("Origin", {0, 0, 0});
  const std::vector<double> spacing = data.numbers("Spacing", {1, 1, 1});

  Image image;
  image.pitch_x_nm = spacing[0];
  image.pitch_y_nm = spacing[1];
  image.origin_x_nm = origin[0] + extent.first_x * spacing[0];
  image.origin_y_nm = origin[1] + extent.first_y * spacing[1];
  const Element piece = only_piece(data);
  const auto points = piece.child("PointData");
  for (const VtkArray& array : points ? points->arrays() : std::vector<VtkArray>{}) {
    if (!array.is_text) append_array(array, *points, extent, image);
  }
  if (image.channels.empty()) {
    throw FileError(file, "it has no values at its points", "Save point data, not cell data");
  }
  apply_attributes(text_fields(data), file, image);
  return image;
}

}  // namespace surf::io
