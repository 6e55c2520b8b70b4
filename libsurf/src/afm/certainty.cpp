// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/certainty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "contact_squares.h"
#include "quantised.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using max_plus::choose_quantum;
using max_plus::Heights;
using max_plus::lowest;
using max_plus::Quanta;
using max_plus::quantise;
using max_plus::TipQuanta;
using max_plus::Touch;

void check(const CertaintyOptions& o) {
  const auto demand = [](bool holds, const char* what, double value, const char* remedy) {
    if (!holds)
      throw InvalidInput("certainty", fmt::format("{} of {:g} is not possible", what, value),
                         remedy);
  };
  demand(o.noise_nm >= 0 && std::isfinite(o.noise_nm), "a noise", o.noise_nm, "Give 0 nm or more");
  demand(o.sigmas > 0 && o.sigmas <= 100, "a multiple", o.sigmas, "Give one above 0, as 3");
  demand(o.neighbourhood >= -1 && o.neighbourhood <= 100, "a neighbourhood", o.neighbourhood,
         "Give 0 to 100 samples");
  demand(o.distance_nm >= 0 && std::isfinite(o.distance_nm), "a distance", o.distance_nm,
         "Give 0 nm or more");
}

/// Adds this many samples on each side, as holes.
HeightField framed(const HeightField& f, int left, int below, int right, int above) {
  const int w = f.z_nm.width(), h = f.z_nm.height();
  HeightField out{{f.pitch_x_nm, f.pitch_y_nm, f.origin_x_nm - left * f.pitch_x_nm,
                   f.origin_y_nm - below * f.pitch_y_nm},
                  Grid<double>(w + left + right, h + below + above),
                  Mask(w + left + right, h + below + above, 0)};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      out.z_nm(x + left, y + below) = f.z_nm(x, y);
      out.valid(x + left, y + below) = f.is_valid(x, y);
    }
  return out;
}

/// A single tip that replaces the hemisphere followed by the tip, but without the lift.
Tip kept_away(const Tip& tip, double distance_nm, int width, int height) {
  const Tip sphere = hemisphere_tip(distance_nm, tip.pitch_x_nm, tip.pitch_y_nm, width, height);
  HeightField field{{tip.pitch()}, tip.z_nm, Mask(tip.z_nm.width(), tip.z_nm.height(), 1)};
  for (std::size_t i = 0; i < field.z_nm.size(); ++i) {
    if (std::isfinite(field.z_nm.data()[i])) continue;
    field.valid.data()[i] = 0;
    field.z_nm.data()[i] = 0;
  }
  const int rx = sphere.apex_x + 1, ry = sphere.apex_y + 1;  // the field needs 2 x 2
  const HeightField both = dilate(framed(field, rx, ry, rx, ry), sphere);
  Tip out{tip.pitch(), both.z_nm, tip.apex_x + rx, tip.apex_y + ry};
  for (int y = 0; y < out.z_nm.height(); ++y)
    for (int x = 0; x < out.z_nm.width(); ++x)
      if (!both.is_valid(x, y)) out.z_nm(x, y) = -std::numeric_limits<double>::infinity();
  return out;
}

Heights eroded(const Heights& upside_down, const Tip& tip, double quantum, int threads,
               const Watch& watch) {
  const TipQuanta b =
      quantise(reflected(tip), quantum, upside_down.z.width(), upside_down.z.height());
  Heights out{{}, -upside_down.top};
  max_plus::convolve(upside_down.z, b.z, b.apex_x, b.apex_y, threads, out.z, nullptr, watch);
  Quanta top = 0;  // largest -z, which is >= 0
  for (const Quanta z : out.z.data())
    if (z >= lowest) top = std::max(top, -z);
  for (Quanta& z : out.z.data())
    if (z >= lowest) z = -z - top;
  out.top += top;
  return out;
}

double largest_height(const HeightField& f) {
  double most = 0;
  for (std::size_t i = 0; i < f.z_nm.size(); ++i)
    if (f.valid.includes(i)) most = std::max(most, std::abs(f.z_nm.data()[i]));
  return most;
}

/// Half the side of the square that contains a rectangle.
int half_side(int width, int height) { return std::max(width, height) / 2; }

int apex_neighbourhood(const Tip& tip, double tolerance_nm) {
  Touch t{tip.apex_x, tip.apex_y, tip.apex_x, tip.apex_y};
  for (int y = 0; y < tip.z_nm.height(); ++y)
    for (int x = 0; x < tip.z_nm.width(); ++x)
      if (tip.z_nm(x, y) >= -tolerance_nm)
        t = {std::min(t.x0, x), std::min(t.y0, y), std::max(t.x1, x), std::max(t.y1, y)};
  return std::min(half_side(t.x1 - t.x0 + 1, t.y1 - t.y0 + 1), 100);
}

/// Marks those possible contacts of an image pixel that fit best.
void mark(const Grid<Quanta>& surface, const TipQuanta& tip, int x, int y, const Touch& t,
          Quanta rounding, unsigned char level, int left, int below, Grid<unsigned char>& map) {
  const auto reach = [&](int X, int Y) {
    return surface(X, Y) + tip.z(x - X + tip.apex_x, y - Y + tip.apex_y);
  };
  Quanta best = 2 * max_plus::unknown;
  for (int Y = t.y0; Y <= t.y1; ++Y)
    for (int X = t.x0; X <= t.x1; ++X) best = std::max(best, reach(X, Y));
  for (int Y = t.y0; Y <= t.y1; ++Y)
    for (int X = t.x0; X <= t.x1; ++X) {
      unsigned char& here = map(X - left, Y - below);
      if (here > level && reach(X, Y) >= best - rounding) here = level;
    }
}

}  // namespace

CertaintyMap certainty_map(const HeightField& image, const Tip& given,
                           const CertaintyOptions& options) {
  check(options);
  max_plus::check_pair(image, given, "image");
  const int w = image.z_nm.width(), h = image.z_nm.height();
  const Tip tip = options.distance_nm > 0 ? kept_away(given, options.distance_nm, w, h) : given;
  // Columns and rows outside the image that a tip inside can touch.
  const int right = std::min(tip.apex_x, w), left = std::min(tip.z_nm.width() - 1 - tip.apex_x, w);
  const int above = std::min(tip.apex_y, h),
            below = std::min(tip.z_nm.height() - 1 - tip.apex_y, h);
  const HeightField wide = framed(image, left, below, right, above);
  const double quantum = choose_quantum(wide, tip, {});
  const Heights surface = eroded(quantise(wide, -1, quantum), tip, quantum, options.threads,
                                 options.watch.part(0, 0.3));

  CertaintyMap out;
  // Most scans are stored as 32-bit floats, which are rounded to 2^-24 of a height.
  const double rounding_nm = 0x1p-22 * largest_height(image) + 4 * quantum;
  out.tolerance_nm = std::max(2 * options.sigmas * options.noise_nm, rounding_nm);
  out.neighbourhood = options.neighbourhood >= 0 ? options.neighbourhood
                      : options.noise_nm > 0     ? apex_neighbourhood(tip, out.tolerance_nm)
                                                 : 0;
  const Heights heights = quantise(wide, 1, quantum);
  const Quanta rounding = static_cast<Quanta>(std::min(rounding_nm / quantum, 0x1p28));
  const double to_least = heights.top - surface.top - std::ceil(out.tolerance_nm / quantum);
  Grid<Quanta> least(wide.z_nm.width(), wide.z_nm.height(), max_plus::unknown);
  for (std::size_t i = 0; i < least.size(); ++i)
    if (heights.z.data()[i] >= lowest)
      least.data()[i] =
          static_cast<Quanta>(std::clamp(heights.z.data()[i] + to_least, double{lowest}, 0x1p29));

  const TipQuanta b = quantise(tip, quantum, wide.z_nm.width(), wide.z_nm.height());
  const Grid<Touch> touches = max_plus::touching(surface.z, b.z, b.apex_x, b.apex_y, least,
                                                 options.threads, options.watch.part(0.3, 1));
  out.level = Grid<unsigned char>(w, h, CertaintyMap::uncertain);
  for (int y = below; y < below + h; ++y)
    for (int x = left; x < left + w; ++x) {
      if (least(x, y) == max_plus::unknown) continue;
      ++out.image_pixels;
      const Touch& t = touches(x, y);
      if (t.x1 < t.x0) {
        ++out.unexplained;
        continue;
      }
      const int half = half_side(t.x1 - t.x0 + 1, t.y1 - t.y0 + 1);
      if (half > out.neighbourhood || t.x0 < left || t.y0 < below || t.x1 >= left + w ||
          t.y1 >= below + h) {
        ++out.ambiguous;
        continue;
      }
      ++out.single;
      mark(surface.z, b, x, y, t, rounding, static_cast<unsigned char>(half), left, below,
           out.level);
    }

  Heights inner{Grid<Quanta>(w, h), surface.top};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) inner.z(x, y) = surface.z(x + left, y + below);
  out.surface = to_field(inner, 1, quantum, image);
  for (double& z : out.surface.z_nm.data()) z -= options.distance_nm;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      out.surface_samples += out.surface.is_valid(x, y);
      out.certain += out.level(x, y) != CertaintyMap::uncertain;
    }
  return out;
}

double pixel_noise_nm(const HeightField& image) {
  validate(image, "image");
  std::vector<double> differences;
  constexpr double weight[3] = {1, -2, 1};
  for (int y = 1; y + 1 < image.z_nm.height(); ++y)
    for (int x = 1; x + 1 < image.z_nm.width(); ++x) {
      double sum = 0;
      bool known = true;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          known = known && image.is_valid(x + i, y + j);
          if (known) sum += weight[i + 1] * weight[j + 1] * image.z_nm(x + i, y + j);
        }
      if (known) differences.push_back(std::abs(sum));
    }
  if (differences.empty()) return 0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return 1.4826 / 6 * *middle;  // for normal noise; the sum of squared weights of the mask is 36
}

}  // namespace surf
