// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>

#include "bytes.h"
#include "surf/core/grid.h"

namespace surf::io {

enum class SampleType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t bytes_of(SampleType type);

/// How an image's samples are stored in a file.
struct SampleLayout {
  SampleType type = SampleType::int16;
  std::endian order = std::endian::little;
  bool top_row_first = false;  ///< false: the lowest row is first
  bool right_column_first = false;
  double scale = 1, offset = 0;  ///< value = scale * sample + offset
};

/// Reads the first width x height samples of `data`; row 0 is the lowest. Throws FileError if
/// samples are missing.
Grid<double> read_samples(const Bytes& data, int width, int height, const SampleLayout& layout);

}  // namespace surf::io
