// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "afm/scan_formats.h"
#include "files/lower_extension.h"
#include "raster/image_formats.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

bool is_image_target(const std::string& extension) {
  return extension == ".tif" || extension == ".tiff" || extension == ".vti";
}

void check_known(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".gsf" && extension != ".txt" && !is_image_target(extension)) {
    throw UsageError(path.string(),
                     fmt::format("surfaces are not written as '{}'", path.extension().string()),
                     "Use .gsf, .tif, .txt or .vti");
  }
  if (extension == ".vti") require_vtk(path.string());
  else if (is_image_target(extension)) require_raster(path.string());
}

/// Formats of 32 bits cannot hold all that 64 bits can.
void check_range(const std::string& file, const HeightField& field) {
  constexpr double most_nm = std::numeric_limits<float>::max();
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (field.is_valid(x, y) && std::abs(field.z_nm(x, y)) > most_nm)
        throw InvalidInput(
            file, fmt::format("a height of {:g} nm is too large for 32 bits", field.z_nm(x, y)),
            "Write .txt");
}

Image image_of(const HeightField& field, const std::map<std::string, std::string>& metadata) {
  Image image = head_of(field, metadata);
  Grid<float> values(field.z_nm.width(), field.z_nm.height());
  for (int y = 0; y < values.height(); ++y)
    for (int x = 0; x < values.width(); ++x)
      values(x, y) = field.is_valid(x, y) ? static_cast<float>(field.z_nm(x, y))
                                          : std::numeric_limits<float>::quiet_NaN();
  image.channels.push_back({"z_nm", "nm", std::move(values)});
  return image;
}

}  // namespace

void write_height_field(const std::filesystem::path& path, const HeightField& field,
                        const std::map<std::string, std::string>& metadata) {
  check_known(path);
  const std::string file = path.string(), extension = lower_extension(path);
  validate(field, file.c_str());
  if (extension != ".txt") check_range(file, field);
  if (extension == ".txt") return write_text(path, format_text_field(field, metadata));
  if (extension == ".gsf") return write_text(path, format_gsf(field, metadata));
  write_image(path, image_of(field, metadata));
}

void check_height_field_target(const std::filesystem::path& path) {
  check_known(path);
  check_writable(path);
}

}  // namespace surf::io
