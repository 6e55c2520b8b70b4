// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_pyramid.h"

#include <algorithm>

namespace surf::bench {

Grid<double> halved(const Grid<double>& from) {
  const int w = from.width(), h = from.height();
  Grid<double> out((w + 1) / 2, (h + 1) / 2);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      double sum = 0;
      int count = 0;
      for (int v = 2 * y; v < std::min(2 * y + 2, h); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, w); ++u) sum += from(u, v), ++count;
      out(x, y) = sum / count;
    }
  return out;
}

Grid<double> doubled(const Grid<double>& from, int width, int height) {
  Grid<double> out(width, height);
  const auto place = [](int fine, int count) {
    return std::clamp((fine + 0.5) / 2 - 0.5, 0.0, count - 1.0);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = place(x, from.width()), v = place(y, from.height());
      const int i = std::min(static_cast<int>(u), std::max(0, from.width() - 2)),
                j = std::min(static_cast<int>(v), std::max(0, from.height() - 2));
      const double s = u - i, t = v - j;
      out(x, y) = (1 - t) * ((1 - s) * from(i, j) + s * from(i + 1, j)) +
                  t * ((1 - s) * from(i, j + 1) + s * from(i + 1, j + 1));
    }
  return out;
}

std::vector<Grid<double>> pyramid(const Grid<double>& finest, int levels) {
  constexpr int least_side = 8;
  std::vector<Grid<double>> out{finest};
  while (static_cast<int>(out.size()) < levels) {
    Grid<double> next = halved(out.back());
    if (std::min(next.width(), next.height()) < least_side) break;
    out.push_back(std::move(next));
  }
  std::ranges::reverse(out);
  return out;
}

Grid<double> refined(Grid<double> from, int width, int height) {
  if (from.width() == width && from.height() == height) return from;
  return doubled(from, width, height);
}

}  // namespace surf::bench
