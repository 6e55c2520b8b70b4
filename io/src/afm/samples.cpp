// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples.h"

#include <cstdint>

namespace surf::io {
namespace {

template <class T>
Grid<double> read(const Bytes& data, int width, int height, const SampleLayout& layout) {
  data.require(0, sizeof(T) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Grid<double> grid(width, height);
  std::size_t at = 0;
  for (int row = 0; row < height; ++row) {
    const int y = layout.top_row_first ? height - 1 - row : row;
    for (int column = 0; column < width; ++column, at += sizeof(T)) {
      const int x = layout.right_column_first ? width - 1 - column : column;
      grid(x, y) =
          layout.scale * static_cast<double>(data.number<T>(at, layout.order)) + layout.offset;
    }
  }
  return grid;
}

}  // namespace

std::size_t bytes_of(SampleType type) {
  switch (type) {
    case SampleType::int8:
    case SampleType::uint8:
      return 1;
    case SampleType::int16:
    case SampleType::uint16:
      return 2;
    case SampleType::int32:
    case SampleType::uint32:
    case SampleType::float32:
      return 4;
    case SampleType::float64:
      return 8;
  }
  return 1;
}

Grid<double> read_samples(const Bytes& data, int width, int height, const SampleLayout& layout) {
  switch (layout.type) {
    case SampleType::int8:
      return read<std::int8_t>(data, width, height, layout);
    case SampleType::uint8:
      return read<std::uint8_t>(data, width, height, layout);
    case SampleType::int16:
      return read<std::int16_t>(data, width, height, layout);
    case SampleType::uint16:
      return read<std::uint16_t>(data, width, height, layout);
    case SampleType::int32:
      return read<std::int32_t>(data, width, height, layout);
    case SampleType::uint32:
      return read<std::uint32_t>(data, width, height, layout);
    case SampleType::float32:
      return read<float>(data, width, height, layout);
    case SampleType::float64:
      return read<double>(data, width, height, layout);
  }
  return {};
}

}  // namespace surf::io
