// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <filesystem>
#include <utility>

#include "surf/core/image.h"
#include "surf/core/placed_image.h"
#include "surf/io/image_file.h"

namespace surf::bench {

/// An image of one signal, as the programs read it; its folder is made.
inline void write_signal(const std::filesystem::path& file, const PlacedImage& image) {
  std::filesystem::create_directories(file.parent_path());
  Image out;
  static_cast<Placement&>(out) = image;
  Grid<float> values(image.values.width(), image.values.height());
  std::ranges::copy(image.values.data(), values.data().begin());
  out.channels = {{"signal", "1", std::move(values)}};
  io::write_image(file, out);
}

}  // namespace surf::bench
