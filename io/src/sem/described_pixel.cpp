// SPDX-License-Identifier: GPL-3.0-or-later
#include "../afm/scan.h"
#include "sem_header.h"

namespace surf::io {
namespace {

constexpr int tag_description = 270, tag_x_resolution = 282, tag_y_resolution = 283;

/// The value of NAME="VALUE" in XML.
std::string attribute(std::string_view text, const std::string& name) {
  const std::string mark = " " + name + "=\"";
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + mark.size());
  return std::string(text.substr(0, text.find('"')));
}

SemHeader of_ome(std::string_view text) {
  SemHeader header;
  header.format = "OME-TIFF";
  const auto side = [&](const std::string& name) {
    const std::string unit = attribute(text, name + "Unit");
    const auto number = scan_number(attribute(text, name));
    const auto nm =
        scan_length_nm(unit.empty() ? "um" : unit);  // micrometres where nothing is said
    return number && nm ? positive(*number * *nm) : std::nullopt;
  };
  set_pixel(header, side("PhysicalSizeX"), side("PhysicalSizeY"), "PhysicalSizeX");
  return header;
}

SemHeader of_imagej(const TiffPage& page, std::string_view text) {
  SemHeader header;
  header.format = "ImageJ";
  header.metadata = parse_settings(text);
  std::string unit = setting(header.metadata, "unit");
  if (unit == "micron" || unit == "\\u00B5m") unit = "um";
  const auto nm = scan_length_nm(unit);
  const auto side = [&](int tag) {
    const auto per_unit = positive(page.number(tag));
    return nm && per_unit ? positive(*nm / *per_unit) : std::nullopt;
  };
  set_pixel(header, side(tag_x_resolution), side(tag_y_resolution), "the resolution of ImageJ");
  return header;
}

}  // namespace

std::optional<SemHeader> described_pixel(const TiffPage& page) {
  const TiffTag* const tag = page.find(tag_description);
  if (!tag) return std::nullopt;
  const std::string_view text = tag->bytes().text();
  SemHeader header;
  if (text.starts_with("ImageJ=")) header = of_imagej(page, text);
  else if (text.find("<OME") != std::string_view::npos) header = of_ome(text);
  return header.pixel_x_nm > 0 ? std::optional(header) : std::nullopt;
}

}  // namespace surf::io
