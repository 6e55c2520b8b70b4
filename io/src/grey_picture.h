// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "surf/core/image_rows.h"

namespace surf::io {

/// One channel as a PNG, stretched between its 0.5 and 99.5 percentiles, or its extremes where these
/// coincide. Pixels that are not finite or not valid do not count and are black. Reads the channel
/// three times and keeps a row at a time.
void write_grey_picture(const std::filesystem::path& target, const std::string& file,
                        const ImageRows& rows, std::size_t channel);

}  // namespace surf::io
