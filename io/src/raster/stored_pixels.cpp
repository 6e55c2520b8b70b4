// SPDX-License-Identifier: GPL-3.0-or-later
#include "stored_pixels.h"

#include <fmt/format.h>

#include "files/damaged.h"
#include "surf/core/error.h"

namespace surf::io {

void require_stored(const std::string& file, double pixel_bytes, double least_bytes,
                    std::uint64_t file_bytes) {
  constexpr double always = 64 << 20;
  if (pixel_bytes <= always || least_bytes <= static_cast<double>(file_bytes)) return;
  throw FileError(
      file,
      fmt::format("its pixels would be {:.3g} GB, and a file of {} bytes cannot hold so many",
                  pixel_bytes / 1e9, file_bytes),
      copy_again);
}

}  // namespace surf::io
