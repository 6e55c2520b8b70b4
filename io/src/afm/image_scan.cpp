// SPDX-License-Identifier: GPL-3.0-or-later
// Heights in EXR, TIFF, PNG and VTI: the channels of images, semsurf's own and plain ones.
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "files/lower_extension.h"
#include "raster/image_formats.h"
#include "scan_formats.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

std::string format_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".exr") return "EXR image";
  if (extension == ".png") return "PNG picture";
  if (extension == ".vti") return "VTK image";
  return "TIFF image";
}

/// Plain images have no units; in ours "1" is that of counts.
std::string unit_of(const Channel& channel, bool ours) {
  if (channel.name == "z_nm") return "nm";
  return channel.unit == "1" && !ours ? std::string{} : channel.unit;
}

Grid<double> values_of(const Channel& channel, const Channel* valid) {
  Grid<double> values(channel.values.width(), channel.values.height());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool hole = valid && valid->values.data()[i] == 0;
    values.data()[i] =
        hole ? std::numeric_limits<double>::quiet_NaN() : double{channel.values.data()[i]};
  }
  return values;
}

}  // namespace

Scan parse_image_scan(const std::filesystem::path& path) {
  const auto image = std::make_shared<const Image>(read_image(path));
  Scan scan;
  scan.format = format_name(path);
  scan.metadata = image->metadata;
  scan.origin_x_nm = image->origin_x_nm;
  scan.origin_y_nm = image->origin_y_nm;
  const bool placed = states_pixel_size(*image);
  const Channel* const valid = image->find("valid");
  for (const Channel& channel : image->channels) {
    if (&channel == valid && image->channels.size() > 1) continue;
    scan.channels.push_back({channel.name, unit_of(channel, !image->metadata.empty()),
                             image->width(), image->height(), placed ? image->pitch_x_nm : 0,
                             placed ? image->pitch_y_nm : 0, false,
                             [image, &channel, valid] { return values_of(channel, valid); }});
  }
  return scan;
}

}  // namespace surf::io
