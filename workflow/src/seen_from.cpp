// SPDX-License-Identifier: GPL-3.0-or-later
#include "seen_from.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "surf/core/sample_image.h"

namespace surf::workflow {
namespace {

constexpr double clearly_other = 0.1;  // of Fisher's transform of correlations
constexpr std::size_t least_pixels = 100;
constexpr std::array quadrants{"BSE-right", "BSE-top", "BSE-left", "BSE-bottom"};

/// By 90 degrees, counter-clockwise.
template <class T>
Grid<T> turned(const Grid<T>& grid) {
  Grid<T> out(grid.height(), grid.width());
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) out(grid.height() - 1 - y, x) = grid(x, y);
  return out;
}

template <class T>
Grid<T> turned(Grid<T> grid, int quarters) {
  for (int i = 0; i < quarters; ++i) grid = turned(grid);
  return grid;
}

/// Fisher's transform: differences of correlations near 1 count for more.
double transformed(double correlation) {
  return std::atanh(std::clamp(correlation, -0.9999, 0.9999));
}

}  // namespace

ModelImages seen_from(const ImageModel& model, const HeightField& field, int quarters,
                      const ModelOptions& options) {
  if (quarters == 0) return model.predict(field, options);
  HeightField other = field;
  other.z_nm = turned(field.z_nm, quarters);
  other.valid = {};
  ModelImages images = model.predict(other, options);
  for (Grid<double>& image : images) image = turned(std::move(image), 4 - quarters);
  return images;
}

bool clearly_larger(double correlation, double than) {
  return transformed(correlation) > transformed(than) + clearly_other;
}

std::string facing_doubt(const std::string& channel,
                         const std::function<double(int quarters)>& correlation_from) {
  const double told = correlation_from(0);
  double best = told;
  int at = 0;
  for (int quarters = 1; quarters < 4; ++quarters)
    if (const double there = correlation_from(quarters); there > best) best = there, at = quarters;
  if (!clearly_larger(best, told)) return {};
  const auto own = std::ranges::find(quadrants, channel);
  const std::string other =
      own == quadrants.end()
          ? fmt::format("a detector {} degrees clockwise from it", 90 * at)
          : quadrants[static_cast<std::size_t>(own - quadrants.begin() + 4 - at) % 4];
  return fmt::format(
      "it looks like the image of {} (correlation {:.2f}, and {:.2f} as {}, which was told): are "
      "images exchanged?",
      other, best, told, channel);
}

double correlation_at(const PlacedImage& image, const PlacedImage& other, const Affine& map) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x) {
      if (!image.is_valid(x, y)) continue;
      const double v = image.values(x, y), w = sample_image(other, map(image.place_nm(x, y)));
      if (!std::isfinite(w)) continue;
      ++n, a += v, b += w, aa += v * v, bb += w * w, ab += v * w;
    }
  if (n < static_cast<double>(least_pixels)) return 0;
  const double va = aa - a * a / n, vb = bb - b * b / n;
  return va > 0 && vb > 0 ? (ab - a * b / n) / std::sqrt(va * vb) : 0;
}

}  // namespace surf::workflow
