// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/cubic_sample.h"
#include "surf/core/error.h"

namespace surf {
namespace {

/// The place of a new sample among the old ones: at the fraction `t` from `left` to the next.
struct Place {
  int left = 0;
  double t = 0;
};

Place place(double at, int count) {
  const double nearest = std::round(at);
  if (std::abs(at - nearest) < 1e-9) at = nearest;  // snaps to a sample
  const int left = std::clamp(static_cast<int>(std::floor(at)), 0, count - 1);
  return {left, left == count - 1 ? 0.0 : at - left};
}

double lerp(double a, double b, double t) { return t == 0 ? a : t == 1 ? b : a + t * (b - a); }

template <class Get>
double bilinear(const Get& z, const Place& x, const Place& y) {
  const auto along = [&](int row) {
    return x.t == 0 ? z(x.left, row) : lerp(z(x.left, row), z(x.left + 1, row), x.t);
  };
  const double low = along(y.left);
  return y.t == 0 ? low : lerp(low, along(y.left + 1), y.t);
}

/// Samples before and after the apex.
struct Extent {
  int before = 0, after = 0;
};

Extent extent(int count, int apex, double ratio) {
  const auto fit = [&](int samples) {
    return static_cast<int>(std::floor(samples / ratio + 1e-9));
  };
  return {fit(apex), fit(count - 1 - apex)};
}

std::vector<Place> places(const Extent& e, int count, int apex, double ratio) {
  std::vector<Place> out;
  for (int k = -e.before; k <= e.after; ++k) out.push_back(place(apex + k * ratio, count));
  return out;
}

}  // namespace

Tip resampled(const Tip& tip, double pitch_x_nm, double pitch_y_nm) {
  validate(tip);
  for (const double pitch : {pitch_x_nm, pitch_y_nm})
    if (!(pitch > 0 && std::isfinite(pitch)))
      throw InvalidInput("tip", fmt::format("it cannot have a pitch of {:g} nm", pitch),
                         "Give one above 0");
  const int w = tip.z_nm.width(), h = tip.z_nm.height();
  const double rx = pitch_x_nm / tip.pitch_x_nm, ry = pitch_y_nm / tip.pitch_y_nm;
  if ((w / rx + 1) * (h / ry + 1) > 0x1p28)
    throw InvalidInput("tip",
                       fmt::format("{} x {} samples of {:g} nm are too many at a pitch of {:g} nm",
                                   w, h, tip.pitch_x_nm, pitch_x_nm),
                       "Cut the tip, or use a coarser pitch");
  const Extent ex = extent(w, tip.apex_x, rx), ey = extent(h, tip.apex_y, ry);
  const std::vector<Place> xs = places(ex, w, tip.apex_x, rx), ys = places(ey, h, tip.apex_y, ry);
  Tip out{{pitch_x_nm, pitch_y_nm},
          Grid<double>(static_cast<int>(xs.size()), static_cast<int>(ys.size())),
          ex.before,
          ey.before,
          tip.doubt};
  constexpr double none = -std::numeric_limits<double>::infinity();
  for (std::size_t y = 0; y < ys.size(); ++y)
    for (std::size_t x = 0; x < xs.size(); ++x) {
      const double z = bilinear(tip.z_nm, xs[x], ys[y]);
      out.z_nm(static_cast<int>(x), static_cast<int>(y)) = std::isnan(z) ? none : z;
    }
  return out;
}

HeightField upsampled(const HeightField& surface, int factor) {
  validate(surface);
  if (factor < 1 || factor > 32)
    throw InvalidInput("upsample", fmt::format("{} is not in 1 to 32", factor), "2 or 3 is usual");
  if (factor == 1) return surface;
  const int w = (surface.z_nm.width() - 1) * factor + 1,
            h = (surface.z_nm.height() - 1) * factor + 1;
  HeightField out{{surface.pitch_x_nm / factor, surface.pitch_y_nm / factor, surface.origin_x_nm,
                   surface.origin_y_nm},
                  Grid<double>(w, h)};
  if (!surface.valid.empty()) out.valid = Mask(w, h, 1);
  const auto sample = [&](int x, int y) {
    return surface.is_valid(x, y) ? surface.z_nm(x, y) : std::numeric_limits<double>::quiet_NaN();
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double z =
          bilinear(sample, place(static_cast<double>(x) / factor, surface.z_nm.width()),
                   place(static_cast<double>(y) / factor, surface.z_nm.height()));
      if (std::isnan(z)) out.valid(x, y) = 0;
      else out.z_nm(x, y) = z;
    }
  return out;
}

namespace {

/// Whether the samples that a cubic takes are all finite.
bool is_whole(const CubicSample& at, const Grid<double>& z) {
  for (const int row : at.row)
    for (const int column : at.column)
      if (!std::isfinite(z(column, row))) return false;
  return true;
}

/// Replaces the bilinear samples of `fine` by cubic ones where all 16 coarse samples are known.
void smooth_over(const Grid<double>& coarse, int factor, Grid<double>& fine) {
  for (int y = 0; y < fine.height(); ++y)
    for (int x = 0; x < fine.width(); ++x) {
      if (x % factor == 0 && y % factor == 0) continue;
      const CubicSample at(static_cast<double>(x) / factor, static_cast<double>(y) / factor,
                           coarse.width(), coarse.height());
      if (is_whole(at, coarse)) fine(x, y) = at.value(coarse);
    }
}

}  // namespace

HeightField smoothly_upsampled(const HeightField& surface, int factor) {
  HeightField out = upsampled(surface, factor);
  Grid<double> coarse = surface.z_nm;
  for (std::size_t i = 0; i < coarse.size(); ++i)
    if (!surface.valid.empty() && !surface.valid.data()[i])
      coarse.data()[i] = std::numeric_limits<double>::quiet_NaN();
  smooth_over(coarse, factor, out.z_nm);
  return out;
}

Tip smoothly_upsampled(const Tip& tip, int factor) {
  validate(tip);
  if (factor < 1 || factor > 32)
    throw InvalidInput("upsample", fmt::format("{} is not in 1 to 32", factor), "2 or 3 is usual");
  Tip out = resampled(tip, tip.pitch_x_nm / factor, tip.pitch_y_nm / factor);
  if (factor == 1 || out.z_nm.width() != (tip.z_nm.width() - 1) * factor + 1 ||
      out.z_nm.height() != (tip.z_nm.height() - 1) * factor + 1)
    return out;
  smooth_over(tip.z_nm, factor, out.z_nm);
  for (double& z : out.z_nm.data()) z = std::min(z, 0.0);
  return out;
}

HeightField resampled(const HeightField& surface, double pitch_nm) {
  validate(surface);
  const double rx = pitch_nm / surface.pitch_x_nm, ry = pitch_nm / surface.pitch_y_nm;
  if (!(pitch_nm > 0 && std::isfinite(pitch_nm)))
    throw InvalidInput("height field", fmt::format("it cannot have a pitch of {:g} nm", pitch_nm),
                       "Give one above 0");
  const double across = std::floor((surface.z_nm.width() - 1) / rx + 1e-9) + 1;
  const double down = std::floor((surface.z_nm.height() - 1) / ry + 1e-9) + 1;
  if (across < 2 || down < 2 || across * down > 0x1p28)
    throw InvalidInput(
        "height field",
        fmt::format("at a pitch of {:g} nm it has {:g} x {:g} samples", pitch_nm, across, down),
        "2 x 2 to 2^28 are possible: choose another pitch");
  const int w = static_cast<int>(across), h = static_cast<int>(down);
  HeightField out{{pitch_nm, pitch_nm, surface.origin_x_nm, surface.origin_y_nm},
                  Grid<double>(w, h)};
  if (!surface.valid.empty()) out.valid = Mask(w, h, 1);
  const auto sample = [&](int x, int y) {
    return surface.is_valid(x, y) ? surface.z_nm(x, y) : std::numeric_limits<double>::quiet_NaN();
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double z = bilinear(sample, place(x * rx, surface.z_nm.width()),
                                place(y * ry, surface.z_nm.height()));
      if (std::isnan(z)) out.valid(x, y) = 0;
      else out.z_nm(x, y) = z;
    }
  return out;
}

}  // namespace surf
