// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/core/placed_image.h"

namespace surf::cli {

/// An SEM image to read, as text.
struct SemInputText {
  std::string file;
  std::optional<std::string> channel, pixel_size;
};

/// Reads it and prints what had to be assumed, unless `quiet`. Throws UsageError, FileError, InvalidInput where the
/// pixel size is not known (also UsageError).
PlacedImage read_sem_input(const SemInputText& input, bool quiet);

}  // namespace surf::cli
