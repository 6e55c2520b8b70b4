// SPDX-License-Identifier: GPL-3.0-or-later
#include "grey_picture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "image_formats.h"
#include "surf/core/units.h"

namespace surf::io {
namespace {

constexpr double low_share = 0.005;
constexpr double high_share = 0.995;

struct Stretch {
  float low = 0;   ///< shown as 0
  float high = 0;  ///< shown as 255
};

/// The values that count in rows of one channel.
class Counted {
 public:
  Counted(const ImageRows& rows, std::size_t channel)
      : rows_(rows), channel_(channel), values_(static_cast<std::size_t>(rows.width)) {
    const auto& channels = rows.head.channels;
    if (channels[channel].name == "valid") return;
    for (std::size_t c = 0; c < channels.size(); ++c)
      if (channels[c].name == "valid") mask_ = c;
  }

  /// Calls use(x, value, counts) for a row.
  template <class Use>
  void row(int y, const Use& use) {
    rows_.read(channel_, y, values_);
    if (mask_) {
      valid_.resize(values_.size());
      rows_.read(*mask_, y, valid_);
    }
    for (std::size_t x = 0; x < values_.size(); ++x)
      use(x, values_[x], std::isfinite(values_[x]) && (!mask_ || valid_[x] != 0));
  }

  /// Calls use(value) for every value that counts.
  template <class Use>
  void all(const Use& use) {
    for (int y = 0; y < rows_.height; ++y)
      row(y, [&](std::size_t, float value, bool counts) {
        if (counts) use(value);
      });
  }

 private:
  const ImageRows& rows_;
  std::size_t channel_;
  std::optional<std::size_t> mask_;
  std::vector<float> values_, valid_;
};

// Whole numbers in the order of the values; -0 is 0.
std::uint32_t order_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
  return bits >> 31 ? ~bits : bits | 0x80000000U;
}
float value_of(std::uint32_t order) {
  return std::bit_cast<float>(order >> 31 ? order & 0x7fffffffU : ~order);
}

using Histogram = std::vector<std::int64_t>;  // of 16 bits

// Where a rank falls; `rank` becomes that within the bin.
std::uint32_t find_bin(const Histogram& histogram, std::int64_t& rank) {
  std::uint32_t bin = 0;
  while (rank >= histogram[bin]) rank -= histogram[bin++];
  return bin;
}

// The exact values of two ranks without sorting: the upper half of their bits in one pass, the
// lower one in another.
Stretch find_stretch(Counted& counted) {
  constexpr std::size_t bins = std::size_t{1} << 16;
  Histogram upper(bins);
  std::int64_t count = 0;
  float least = std::numeric_limits<float>::infinity(), most = -least;
  counted.all([&](float value) {
    ++upper[order_of(value) >> 16];
    ++count;
    least = std::min(least, value);
    most = std::max(most, value);
  });
  if (count == 0) return {};
  std::int64_t low_rank = std::lround(low_share * static_cast<double>(count - 1));
  std::int64_t high_rank = std::lround(high_share * static_cast<double>(count - 1));
  const std::uint32_t low_bin = find_bin(upper, low_rank), high_bin = find_bin(upper, high_rank);
  Histogram low(bins), high(bins);
  counted.all([&](float value) {
    const std::uint32_t order = order_of(value);
    if (order >> 16 == low_bin) ++low[order & 0xffff];
    if (order >> 16 == high_bin) ++high[order & 0xffff];
  });
  const Stretch stretch{value_of(low_bin << 16 | find_bin(low, low_rank)),
                        value_of(high_bin << 16 | find_bin(high, high_rank))};
  return stretch.high > stretch.low ? stretch : Stretch{least, most};
}

unsigned char grey_of(float value, const Stretch& stretch) {
  if (!(stretch.high > stretch.low)) return 128;
  const double scale = double{stretch.high} - double{stretch.low};
  const double t = (double{value} - double{stretch.low}) / scale;
  return static_cast<unsigned char>(std::lround(255 * std::clamp(t, 0.0, 1.0)));
}

}  // namespace

void write_grey_picture(const std::filesystem::path& target, const std::string& file,
                        const ImageRows& rows, std::size_t channel) {
  Counted counted(rows, channel);
  const Stretch stretch = find_stretch(counted);
  Image shown = without_channels(rows.head);
  shown.channels.push_back(rows.head.channels[channel]);
  shown.metadata[stretch_low_key] = format_exact(double{stretch.low});
  shown.metadata[stretch_high_key] = format_exact(double{stretch.high});
  write_png(target, file, shown, rows.width, rows.height,
            [&](int y, std::span<unsigned char> grey) {
              counted.row(y, [&](std::size_t x, float value, bool counts) {
                grey[x] = counts ? grey_of(value, stretch) : static_cast<unsigned char>(0);
              });
            });
}

GreyPicture make_grey_picture(const ImageRows& rows, std::size_t channel) {
  Counted counted(rows, channel);
  const Stretch stretch = find_stretch(counted);
  GreyPicture picture{Grid<std::uint8_t>(rows.width, rows.height), stretch.low, stretch.high};
  for (int y = 0; y < rows.height; ++y) {
    counted.row(y, [&](std::size_t x, float value, bool counts) {
      picture.grey(static_cast<int>(x), y) = counts ? grey_of(value, stretch) : std::uint8_t{0};
    });
  }
  return picture;
}

}  // namespace surf::io
