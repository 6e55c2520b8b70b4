// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "surf/core/image_rows.h"
#include "surf/core/large_grid.h"
#include "surf/io/image_file.h"

namespace surf::io {

/// Width and height of a tile in pixels.
inline constexpr int tile_edge = 128;

/// The sizes of an image and of its repeated halves, rounded up, until neither side exceeds
/// `smallest`.
std::vector<ImageSize> pyramid_sizes(int width, int height, int smallest);

/// The placement of level `level` of an image with `height` rows: its pixels are 2^level times as
/// large, and the upper left corner stays in place.
Image placed_at_level(Image image, int height, int level);

/// An image in ever smaller sizes. Each value is the mean of the up to four finite values below it;
/// for labels (materials as numbers) the first of them. Rows are counted from the top, as in files.
class Pyramid {
 public:
  /// Levels that take more than some hundred MB go into scratch files in `scratch_folder`.
  Pyramid(const ImageRows& image, std::span<const std::string> labels, int smallest,
          const std::string& scratch_folder);

  /// Adds `rows` of a channel of the image itself, beginning with row `first`, which is even. Their
  /// number is even, except at the end.
  void add(std::size_t channel, int first, std::span<const float> rows);

  /// Call this when all rows of all channels have been added.
  void finish();

  /// Number of levels. The image is level 0.
  int levels() const { return static_cast<int>(sizes_.size()); }
  ImageSize size(int level) const { return sizes_[static_cast<std::size_t>(level)]; }

  /// A row of a level above 0.
  std::span<const float> row(int level, std::size_t channel, int y) const;
  /// See LargeGrid::release.
  void release() const;

 private:
  using Level = std::vector<LargeGrid<float>>;  // by channel

  Level make_level(ImageSize size) const;

  std::vector<ImageSize> sizes_;
  std::vector<bool> is_label_;
  std::string scratch_folder_;
  std::vector<Level> levels_;  // from level 1 on
};

}  // namespace surf::io
