// SPDX-License-Identifier: GPL-3.0-or-later
#include "pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surf::io {
namespace {

constexpr std::size_t most_memory = std::size_t{256} << 20;  // bytes of a level

// Of up to two by two values below a pixel.
float join(std::span<const float> upper, std::span<const float> lower, std::size_t x, bool label) {
  if (label) return upper[x];
  double sum = 0;
  int count = 0;
  for (const auto& row : {upper, lower})
    for (std::size_t i = x; i < std::min(x + 2, row.size()); ++i)
      if (std::isfinite(row[i])) {
        sum += row[i];
        ++count;
      }
  return count > 0 ? static_cast<float>(sum / count) : std::numeric_limits<float>::quiet_NaN();
}

// Without a lower row it is empty.
void halve(std::span<const float> upper, std::span<const float> lower, bool label,
           std::span<float> into) {
  for (std::size_t x = 0; x < into.size(); ++x) into[x] = join(upper, lower, 2 * x, label);
}

template <class T>
auto row_of(T& grid, int y) {
  const auto width = static_cast<std::size_t>(grid.width());
  return grid.data().subspan(static_cast<std::size_t>(y) * width, width);
}

}  // namespace

std::vector<ImageSize> pyramid_sizes(int width, int height, int smallest) {
  std::vector<ImageSize> sizes{{width, height}};
  while (std::max(width, height) > smallest) {
    width = (width + 1) / 2;
    height = (height + 1) / 2;
    sizes.push_back({width, height});
  }
  return sizes;
}

Image placed_at_level(Image placed, int height, int level) {
  for (int k = 0; k < level; ++k) {
    // The upper edge stays: with an odd number of rows the lowest pixels reach beyond the image.
    const double top_nm = placed.origin_y_nm + (height - 0.5) * placed.pitch_y_nm;
    height = (height + 1) / 2;
    placed.origin_x_nm += 0.5 * placed.pitch_x_nm;
    placed.pitch_x_nm *= 2;
    placed.pitch_y_nm *= 2;
    placed.origin_y_nm = top_nm - (height - 0.5) * placed.pitch_y_nm;
  }
  return placed;
}

Pyramid::Pyramid(const ImageRows& image, std::span<const std::string> labels, int smallest,
                 const std::string& scratch_folder)
    : sizes_(pyramid_sizes(image.width, image.height, smallest)), scratch_folder_(scratch_folder) {
  for (const Channel& channel : image.head.channels)
    is_label_.push_back(std::find(labels.begin(), labels.end(), channel.name) != labels.end());
  if (levels() > 1) levels_.push_back(make_level(sizes_[1]));
}

Pyramid::Level Pyramid::make_level(ImageSize size) const {
  const std::size_t bytes = static_cast<std::size_t>(size.width) *
                            static_cast<std::size_t>(size.height) * sizeof(float) *
                            is_label_.size();
  Level level;
  for (std::size_t c = 0; c < is_label_.size(); ++c)
    level.emplace_back(size.width, size.height,
                       bytes > most_memory ? scratch_folder_ : std::string());
  return level;
}

void Pyramid::add(std::size_t channel, int first, std::span<const float> rows) {
  if (levels_.empty()) return;
  const auto width = static_cast<std::size_t>(sizes_[0].width);
  const std::size_t count = rows.size() / width;
  for (std::size_t y = 0; y < count; y += 2)
    halve(rows.subspan(y * width, width),
          y + 1 < count ? rows.subspan((y + 1) * width, width) : std::span<const float>(),
          is_label_[channel], row_of(levels_[0][channel], (first + static_cast<int>(y)) / 2));
}

void Pyramid::finish() {
  for (std::size_t k = 1; k + 1 < sizes_.size(); ++k) {
    levels_.push_back(make_level(sizes_[k + 1]));
    const Level& below = levels_[k - 1];
    for (std::size_t c = 0; c < is_label_.size(); ++c)
      for (int y = 0; y < sizes_[k + 1].height; ++y) {
        if (y % tile_edge == 0) release();
        halve(
            row_of(below[c], 2 * y),
            2 * y + 1 < below[c].height() ? row_of(below[c], 2 * y + 1) : std::span<const float>(),
            is_label_[c], row_of(levels_[k][c], y));
      }
    release();
  }
}

std::span<const float> Pyramid::row(int level, std::size_t channel, int y) const {
  return row_of(levels_[static_cast<std::size_t>(level) - 1][channel], y);
}

void Pyramid::release() const {
  for (const Level& level : levels_)
    for (const LargeGrid<float>& grid : level) grid.release();
}

}  // namespace surf::io
