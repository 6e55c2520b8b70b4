// SPDX-License-Identifier: GPL-3.0-or-later
// What writers of EXR, TIFF and PNG share: they alone know OpenImageIO.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

#include "surf/core/image.h"

namespace surf::io::openimageio {

/// In the text of a TIFF page: how many pages there are, and how many levels of each.
inline constexpr const char* pages_key = "image:pages";
inline constexpr const char* levels_key = "image:levels";

/// Debian's OpenImageIO prints notes for its developers otherwise.
void keep_quiet();

/// Throws Unsupported where the library lacks the format. `file` is the name for messages, here and
/// below.
std::unique_ptr<OIIO::ImageOutput> create_output(const char* format, const std::string& file);

/// OpenImageIO gives files without a date the present one. A date that is no text is left out.
void leave_out_date(OIIO::ImageSpec& spec);

/// Throws FileError with what the library says, unless it is done.
void check_written(bool done, OIIO::ImageOutput& output, const std::string& file);
void close_output(OIIO::ImageOutput& output, const std::string& file);

/// Pixels per centimetre, where the format's tags can hold that.
void set_resolution(OIIO::ImageSpec& spec, const Image& image, double highest);

}  // namespace surf::io::openimageio
