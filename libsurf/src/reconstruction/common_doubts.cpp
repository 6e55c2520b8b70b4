// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_doubts.h"

#include <algorithm>
#include <cmath>

#include "afm/normal_numbers.h"
#include "core/cubic_sample.h"

namespace surf::reconstruction {
namespace {

/// What heights change by where the surface is displaced by draws of the place, in squares. Slopes
/// alone would leave plateaus as they are, however far the place may be off.
Grid<double> squares_of_place(const CommonDoubts& doubts, const Grid<double>& soft) {
  constexpr int draws = 32;
  const double root_x = std::sqrt(doubts.place.along_x), root_y = std::sqrt(doubts.place.along_y);
  const double common =
      root_x > 0 && root_y > 0 ? std::clamp(doubts.place.both / (root_x * root_y), -1.0, 1.0) : 0;
  NormalNumbers normal(doubts.seed, 5);
  const int w = soft.width(), h = soft.height();
  Grid<double> squares(w, h);
  for (int d = 0; d < draws; ++d) {
    const double first = normal(), second = normal();
    const double by_x = root_x * first;
    const double by_y = root_y * (common * first + std::sqrt(1 - common * common) * second);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const CubicSample there(std::clamp(x + by_x, 0.0, w - 1.0),
                                std::clamp(y + by_y, 0.0, h - 1.0), w, h);
        squares(x, y) += std::pow(there.value(soft) - soft(x, y), 2) / draws;
      }
  }
  return squares;
}

}  // namespace

void add(const CommonDoubts& doubts, const HeightField& surface, const Grid<double>& soft,
         const Affine& surface_to_afm, Grid<double>& deviation_nm) {
  const int w = soft.width(), h = soft.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const Point2 p = surface_to_afm({surface.x_nm(x), surface.y_nm(y)});
      double square = deviation_nm(x, y) * deviation_nm(x, y) +
                      std::pow(doubts.level.x * (p.x - doubts.middle.x), 2) +
                      std::pow(doubts.level.y * (p.y - doubts.middle.y), 2);
      if (x > 0 && y > 0 && x + 1 < w && y + 1 < h)
        square += 0.25 * doubts.edge_px * doubts.edge_px *
                  (std::pow(soft(x + 1, y) - soft(x - 1, y), 2) +
                   std::pow(soft(x, y + 1) - soft(x, y - 1), 2));
      deviation_nm(x, y) = std::sqrt(square);
    }
  if (!(doubts.place.along_x > 0) && !(doubts.place.along_y > 0)) return;
  const Grid<double> squares = squares_of_place(doubts, soft);
  for (std::size_t i = 0; i < squares.size(); ++i)
    deviation_nm.data()[i] =
        std::sqrt(deviation_nm.data()[i] * deviation_nm.data()[i] + squares.data()[i]);
}

}  // namespace surf::reconstruction
