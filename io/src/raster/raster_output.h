// SPDX-License-Identifier: GPL-3.0-or-later
// Functions shared by the writers of EXR, TIFF and PNG, the only users of OpenImageIO.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

#include "surf/core/image.h"

namespace surf::io::openimageio {

/// Keys in the text of a TIFF page: the number of pages, and the number of levels of each.
inline constexpr const char* pages_key = "image:pages";
inline constexpr const char* levels_key = "image:levels";

/// Suppresses the developer messages that Debian's OpenImageIO prints.
void keep_quiet();

/// Throws Unsupported if the library lacks the format. `file` is the name for messages, here and
/// below.
std::unique_ptr<OIIO::ImageOutput> create_output(const char* format, const std::string& file);

/// Prevents a date in the file: OpenImageIO gives files without a date the present one, but leaves
/// out a date that is not a text.
void leave_out_date(OIIO::ImageSpec& spec);

/// Throws FileError with the library's message unless `done`.
void check_written(bool done, OIIO::ImageOutput& output, const std::string& file);
void close_output(OIIO::ImageOutput& output, const std::string& file);

/// Sets the pixels per centimetre if the format's tags can hold the number.
void set_resolution(OIIO::ImageSpec& spec, const Image& image, double highest);

}  // namespace surf::io::openimageio
