// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "surf/core/parameters.h"
#include "surf/io/web_page.h"

namespace surf::workflow {

/// FILE or FILE:CHANNEL.
struct FileChannel {
  std::filesystem::path file;
  std::string channel;  ///< empty: the first
};

/// A name that is a file stays whole, colons and all. Throws FileError where there is no such file.
FileChannel parse_file_channel(const std::string& text);

/// Of scans and pictures that do not say.
struct GivenPitch {
  std::optional<double> x_nm, y_nm;
};

/// As that of pictures: picture.pixel_size.
void describe(ParameterVisitor& visit, GivenPitch& pitch);

/// A picture, or one channel of a scan in its own unit, as an image. Throws UsageError for a
/// channel that is not there.
io::WebImage read_picture(const FileChannel& input, const GivenPitch& given);

/// A picture of a general format (surf/io/image_file.h).
io::WebImage read_plain_picture(const FileChannel& input, const GivenPitch& given);

/// A picture to lay on surfaces, and which of its channels: the one asked for, else the first.
/// Throws InvalidInput if it does not say how large its pixels are.
struct PlacedPicture {
  io::WebImage picture;
  std::string channel;
};
PlacedPicture read_placed_picture(const FileChannel& input, const GivenPitch& given);

}  // namespace surf::workflow
