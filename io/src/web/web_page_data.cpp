// SPDX-License-Identifier: GPL-3.0-or-later
#include "web_page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "files/base64.h"
#include "files/deflate.h"
#include "raster/grey_picture.h"
#include "raster/image_formats.h"

namespace surf::io {
namespace {

using nlohmann::json;

json describe_field(const HeightField& field, WebBlobs& blobs) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int y = 0; y < field.z_nm.height(); ++y) {
    for (int x = 0; x < field.z_nm.width(); ++x) {
      if (!field.is_valid(x, y)) continue;
      low = std::min(low, field.z_nm(x, y));
      high = std::max(high, field.z_nm(x, y));
    }
  }
  const double middle = low <= high ? low + (high - low) / 2 : 0;
  std::vector<float> heights(field.z_nm.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (field.valid.includes(i)) heights[i] = static_cast<float>(field.z_nm.data()[i] - middle);
  }
  return {{"kind", "grid"},
          {"size", {field.z_nm.width(), field.z_nm.height()}},
          {"pitch_nm", {field.pitch_x_nm, field.pitch_y_nm}},
          {"origin_nm", {field.origin_x_nm, field.origin_y_nm}},
          {"middle_nm", middle},
          {"heights", blobs.add_numbers(heights)}};
}

json describe_mesh(const TriangleMesh& mesh, WebBlobs& blobs) {
  const Box box = bounds(mesh);
  const Vec3 middle = box.lower_nm + 0.5 * box.size_nm();
  std::vector<float> positions;
  positions.reserve(3 * mesh.vertices_nm.size());
  for (int axis = 0; axis < 3; ++axis) {  // all x, all y, all z: neighbours differ less
    for (const Vec3& vertex : mesh.vertices_nm) {
      const Vec3 from_middle = vertex - middle;
      positions.push_back(static_cast<float>(axis == 0   ? from_middle.x
                                             : axis == 1 ? from_middle.y
                                                         : from_middle.z));
    }
  }
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  return {{"kind", "mesh"},
          {"middle_nm", {middle.x, middle.y, middle.z}},
          {"positions", blobs.add_numbers(positions)},
          {"corners", blobs.add_numbers(corners)}};
}

}  // namespace

json WebBlobs::add(const std::string& kind, const std::string& bytes) {
  html_ += fmt::format("<script type=\"{}\" id=\"data{}\">{}</script>\n", kind, count_,
                       encode_base64(bytes));
  return {{"data", count_++}};
}

json WebBlobs::add_words(const std::string& type, const std::vector<std::uint32_t>& words) {
  std::string planes(4 * words.size(), '\0');
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t difference = words[i] - before;
    before = words[i];
    for (unsigned plane = 0; plane < 4; ++plane)
      planes[plane * words.size() + i] = static_cast<char>(difference >> 8 * plane & 0xff);
  }
  json place = add("semsurf/numbers", deflate(planes));
  place["type"] = type;
  place["count"] = words.size();
  return place;
}

json WebBlobs::add_numbers(const std::vector<float>& values) {
  std::vector<std::uint32_t> words(values.size());
  std::transform(values.begin(), values.end(), words.begin(),
                 [](float value) { return std::bit_cast<std::uint32_t>(value); });
  return add_words("float32", words);
}

json WebBlobs::add_numbers(const std::vector<std::uint32_t>& values) {
  return add_words("uint32", values);
}

json WebBlobs::add_png(const std::string& bytes) { return add("semsurf/png", bytes); }

json describe(const WebSurface& surface, WebBlobs& blobs) {
  json description = std::holds_alternative<HeightField>(surface.shape)
                         ? describe_field(std::get<HeightField>(surface.shape), blobs)
                         : describe_mesh(std::get<TriangleMesh>(surface.shape), blobs);
  description["name"] = surface.name;
  description["metadata"] = surface.metadata;
  description["scalars"] = json::array();
  for (const WebScalar& scalar : surface.scalars) {
    description["scalars"].push_back({{"name", scalar.name},
                                      {"unit", scalar.unit},
                                      {"values", blobs.add_numbers(scalar.values)}});
  }
  return description;
}

json describe(const WebImage& image, WebBlobs& blobs) {
  json description = {{"name", image.name},
                      {"size", {image.image.width(), image.image.height()}},
                      {"metadata", image.image.metadata},
                      {"channels", json::array()}};
  if (image.has_scale) {
    description["pitch_nm"] = {image.image.pitch_x_nm, image.image.pitch_y_nm};
    description["origin_nm"] = {image.image.origin_x_nm, image.image.origin_y_nm};
  }
  const ImageRows rows = rows_of(image.image);
  for (std::size_t c = 0; c < image.image.channels.size(); ++c) {
    const Channel& channel = image.image.channels[c];
    if (channel.name == "valid") continue;
    const GreyPicture picture = make_grey_picture(rows, c);
    json of_channel = blobs.add_png(format_grey_png(image.name, picture.grey));
    of_channel["name"] = channel.name;
    of_channel["unit"] = channel.unit;
    of_channel["low"] = picture.low;
    of_channel["high"] = picture.high;
    description["channels"].push_back(std::move(of_channel));
  }
  return description;
}

}  // namespace surf::io
