// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/image_rows.h"

#include <algorithm>
#include <utility>

namespace surf {

ImageRows rows_of(const Image& image) {
  ImageRows rows;
  rows.head.placement() = image.placement();
  rows.head.metadata = image.metadata;
  for (const Channel& channel : image.channels)
    rows.head.channels.push_back({channel.name, channel.unit, {}});
  rows.width = image.width();
  rows.height = image.height();
  rows.read = [&image](std::size_t channel, int y, std::span<float> row) {
    const auto begin = image.channels[channel].values.data().begin() +
                       static_cast<std::ptrdiff_t>(y) * image.width();
    std::copy(begin, begin + image.width(), row.begin());
  };
  return rows;
}

Image to_image(const ImageRows& rows) {
  Image image = rows.head;
  const auto width = static_cast<std::size_t>(rows.width);
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    Grid<float>& values = image.channels[c].values;
    values = Grid<float>(rows.width, rows.height);
    for (int y = 0; y < rows.height; ++y)
      rows.read(c, y, std::span(values.data()).subspan(static_cast<std::size_t>(y) * width, width));
  }
  return image;
}

}  // namespace surf
