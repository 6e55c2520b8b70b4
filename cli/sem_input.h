// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/placed_image.h"
#include "surf/io/sem_file.h"

namespace surf::cli {

/// Reads an SEM image and prints what had to be assumed, unless `quiet`. Throws UsageError,
/// FileError, InvalidInput where the pixel size is not known (also UsageError).
PlacedImage read_sem_input(const std::string& file, const io::SemReadOptions& options, bool quiet);

}  // namespace surf::cli
