// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "surf/core/height_field.h"
#include "surf/core/image.h"

namespace surf::io {

struct ImageWriteOptions {
  /// The channel that formats with a single picture (PNG) show; empty: the first.
  std::string channel;
};

/// Writes by extension: EXR (named 32-bit float channels), TIFF (one 32-bit float page per channel,
/// its name in ImageDescription), PNG (8-bit grey, stretched between the 0.5 and 99.5 percentiles;
/// the range is in the metadata) and VTI (ParaView, inline binary, one array per channel, placed in
/// space). Row 0 of the file is the top. Pitch, origin, units and metadata go along where the format
/// can hold them. The file appears under its name only when it is complete.
/// Throws FileError, UsageError for an unknown extension or channel, Unsupported where this build
/// lacks the format.
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {});

/// Throws what `write_image` would for the name, folder or channel, before any work is spent.
void check_image_target(const std::filesystem::path& path, const Image* image = nullptr,
                        const ImageWriteOptions& options = {});

/// Reads what `write_image` wrote (EXR, TIFF, PNG, VTI) and plain images of these formats: channels
/// named by the file or "L", "R", "G", "B", "A"; pitch 1 nm where the file has none.
Image read_image(const std::filesystem::path& path);

bool is_image_file(const std::filesystem::path& path);

/// One channel of an image as heights in nm: values times `z_unit_nm`.
HeightField to_height_field(const Image& image, const std::string& channel, double z_unit_nm = 1);

}  // namespace surf::io
