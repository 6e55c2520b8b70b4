// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/characterizer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "surf/afm/morphology.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const HeightField& scan, const HeightField& known, const CharacterizerOptions& o) {
  validate(scan, "scan");
  validate(known, "characterizer");
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-6 * std::max(a, b); };
  if (differ(scan.pitch_x_nm, known.pitch_x_nm) || differ(scan.pitch_y_nm, known.pitch_y_nm))
    throw InvalidInput(
        "characterizer",
        fmt::format("its pitch is {:g} x {:g} nm, the scan's {:g} x {:g} nm", known.pitch_x_nm,
                    known.pitch_y_nm, scan.pitch_x_nm, scan.pitch_y_nm),
        "Resample it to the scan's");
  if (o.width < 1 || o.height < 1 || o.search < 0 || o.search > 100000)
    throw InvalidInput("characterizer",
                       fmt::format("a tip of {} x {} samples and a search of {} are not possible",
                                   o.width, o.height, o.search),
                       "Give a size above 0 and a search from 0");
}

/// The part of the characterizer that stays inside the scan for every u within `reach`.
struct Core {
  int x0, y0, x1, y1;  // [x0, x1)
};

Core core_of(const HeightField& scan, const HeightField& known, int reach_x, int reach_y) {
  const Core c{std::max(0, reach_x), std::max(0, reach_y),
               std::min(known.z_nm.width(), scan.z_nm.width() - reach_x),
               std::min(known.z_nm.height(), scan.z_nm.height() - reach_y)};
  if (c.x1 - c.x0 >= 2 && c.y1 - c.y0 >= 2) return c;
  throw InvalidInput("characterizer",
                     "too little of it stays inside the scan for this tip and search",
                     "Use a larger scan, a smaller tip or a smaller search");
}

/// min over the core of I(x + u) - C(x). Stops as soon as it falls below `enough`.
double eroded(const HeightField& scan, const HeightField& known, const Core& c, int u, int v,
              double enough) {
  double least = infinity;
  for (int y = c.y0; y < c.y1 && least >= enough; ++y)
    for (int x = c.x0; x < c.x1; ++x)
      if (known.is_valid(x, y) && scan.is_valid(x + u, y + v))
        least = std::min(least, scan.z_nm(x + u, y + v) - known.z_nm(x, y));
  return least;
}

double residual(const HeightField& scan, const HeightField& known, const CharacterizedTip& found,
                int threads) {
  const HeightField image = dilate(known, found.tip, {.threads = threads});
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < image.z_nm.height(); ++y)
    for (int x = 0; x < image.z_nm.width(); ++x) {
      const int X = x + found.offset_x, Y = y + found.offset_y;
      if (X < 0 || Y < 0 || X >= scan.z_nm.width() || Y >= scan.z_nm.height()) continue;
      if (!image.is_valid(x, y) || !scan.is_valid(X, Y)) continue;
      sum += std::pow(scan.z_nm(X, Y) - image.z_nm(x, y) - found.offset_z_nm, 2);
      ++count;
    }
  return count ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

}  // namespace

CharacterizedTip tip_from_characterizer(const HeightField& scan, const HeightField& characterizer,
                                        const CharacterizerOptions& o) {
  check(scan, characterizer, o);
  const int apex_x = o.width / 2, apex_y = o.height / 2;
  const Core core =
      core_of(scan, characterizer, o.search + o.width - apex_x, o.search + o.height - apex_y);
  CharacterizedTip out;
  double highest = -infinity;
  // From the centre outwards, so that the smallest of equally good offsets is chosen.
  for (int ring = 0; ring <= o.search; ++ring)
    for (int v = -ring; v <= ring; ++v)
      for (int u = -ring; u <= ring; ++u) {
        if (std::max(std::abs(u), std::abs(v)) != ring) continue;
        const double z = eroded(scan, characterizer, core, u, v, highest);
        if (!(z > highest) || z == infinity) continue;
        highest = z;
        out.offset_x = u;
        out.offset_y = v;
      }
  if (highest == -infinity)
    throw InvalidInput("scan", "it and the characterizer have no valid height in common",
                       "Use another scan");
  out.offset_z_nm = highest;
  out.offset_at_limit =
      o.search > 0 && std::max(std::abs(out.offset_x), std::abs(out.offset_y)) == o.search;
  out.tip = {scan.pitch(), Grid<double>(o.width, o.height), apex_x, apex_y};
  parallel_for(static_cast<std::size_t>(o.height), o.threads, [&](std::size_t row, int) {
    const int j = static_cast<int>(row);
    for (int i = 0; i < o.width; ++i)
      out.tip.z_nm(i, j) =
          std::min(0.0, eroded(scan, characterizer, core, out.offset_x + i - apex_x,
                               out.offset_y + j - apex_y, -infinity) -
                            highest);
  });
  out.residual_nm = residual(scan, characterizer, out, o.threads);
  return out;
}

}  // namespace surf
