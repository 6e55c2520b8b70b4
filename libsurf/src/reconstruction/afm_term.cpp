// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm_term.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/cubic_sample.h"
#include "reconstruction/in_chunks.h"
#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reconstruction/afm_term.cpp"
#include "core/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace surf::reconstruction::HWY_NAMESPACE {

// Updates a row of the dilation by one tip sample, where it gives a higher value.
void raise(float* __restrict made, std::int32_t* __restrict touching,
           const float* __restrict surface, float offset, std::int32_t sample, int count) {
  for (int x = 0; x < count; ++x) {
    const float v = surface[x] + offset;
    const bool higher = v > made[x];
    touching[x] = higher ? sample : touching[x];
    made[x] = higher ? v : made[x];
  }
}

}  // namespace surf::reconstruction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf::reconstruction {
namespace {

HWY_EXPORT(raise);

constexpr float deepest = -std::numeric_limits<float>::infinity();

int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

AfmTerm::AfmTerm(const AfmData& data, const HeightField& outside, const SurfaceFrame& frame,
                 const Affine& surface_to_afm, int threads)
    : image_(data.image), noise_(data.noise), first_tip_(data.tip),
      tip_(smoothly_upsampled(data.tip, data.upsample)), family_(tip_), factor_(data.upsample),
      frame_(frame), threads_(resolve_threads(threads)) {
  set_outside(outside);
  const int w = image_.z_nm.width(), h = image_.z_nm.height();
  used_ = Mask(w, h);
  spans_.assign(h, {w, -1});
  const Affine map = to_samples(surface_to_afm);
  first_row_ = h;
  double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (!image_.is_valid(x, y)) continue;
      const Point2 nm{image_.x_nm(x), image_.y_nm(y)}, p = map(nm);
      if (p.x < 0 || p.y < 0 || p.x > frame_.width - 1 || p.y > frame_.height - 1) continue;
      used_(x, y) = 1;
      ++used_pixels_;
      spans_[y] = {std::min(spans_[y][0], x), std::max(spans_[y][1], x)};
      first_row_ = std::min(first_row_, y);
      last_row_ = y;
      left = std::min(left, nm.x);
      right = std::max(right, nm.x);
      low = std::min(low, nm.y);
      high = std::max(high, nm.y);
    }
  if (used_pixels_ == 0) return;
  middle_ = {0.5 * (left + right), 0.5 * (low + high)};
  reach_nm_ = std::max({right - left, high - low, frame_.pitch_nm}) / 2;
}

void AfmTerm::set_outside(const HeightField& outside) {
  outside_ = smoothly_upsampled(outside, factor_).z_nm;
}

/// The map from the AFM's frame to samples of the surface.
Affine AfmTerm::to_samples(const Affine& surface_to_afm) const {
  const double f = 1 / frame_.pitch_nm;
  return compose({f, 0, -frame_.origin_x_nm * f, 0, f, -frame_.origin_y_nm * f},
                 inverse(surface_to_afm));
}

Affine AfmTerm::moved(const Affine& surface_to_afm, const MapChange& c) const {
  const Affine map = to_samples(surface_to_afm);
  const double r = 1 / reach_nm_;
  Affine m = map;
  m.xx += c[1] * r;
  m.xy += c[2] * r;
  m.x0 += c[0] - (c[1] * middle_.x + c[2] * middle_.y) * r;
  m.yx += c[4] * r;
  m.yy += c[5] * r;
  m.y0 += c[3] - (c[4] * middle_.x + c[5] * middle_.y) * r;
  const double p = frame_.pitch_nm;
  return inverse(compose({p, 0, frame_.origin_x_nm, 0, p, frame_.origin_y_nm}, m));
}

AfmTerm::State AfmTerm::evaluate(const Grid<double>& z, const Affine& surface_to_afm,
                                 const TipChange& tip_change, const Point2& drift_px) const {
  State s;
  const Tip tip = family_.changed(tip_, tip_change, &s.by_tip);
  const int w = image_.z_nm.width(), h = image_.z_nm.height();
  s.simulated = Grid<double>(w, h);
  s.residual = Grid<double>(w, h);
  s.contacts.assign(s.simulated.size(), {});
  if (used_pixels_ == 0) {
    s.pull = Grid<double>(w, h);
    return s;
  }
  const Affine straight = to_samples(surface_to_afm);
  const auto map = [&](const Point2& nm) {
    const double share = drift_share((nm.y - middle_.y) / reach_nm_);
    const Point2 p = straight(nm);
    return Point2{p.x + share * drift_px.x, p.y + share * drift_px.y};
  };
  const int f = factor_, tw = tip.z_nm.width(), th = tip.z_nm.height();
  const double step_x = image_.pitch_x_nm / f, step_y = image_.pitch_y_nm / f;

  // The fine samples that the tip can reach from the used pixels: columns [begin, begin + f plane),
  // rows likewise. Tip sample i lies over surface column f x - (i - apex), so the reach is that of
  // the rotated tip.
  int first_column = w, last_column = -1;
  for (const auto& span : spans_) {
    first_column = std::min(first_column, span[0]);
    last_column = std::max(last_column, span[1]);
  }
  const int right_of = tip.apex_x,
            left_of = tw - 1 - tip.apex_x;  // reach from a pixel, in fine samples
  const int above = tip.apex_y, below = th - 1 - tip.apex_y;
  const int first_plane = floor_div(f * first_column - left_of, f),
            last_plane = floor_div(f * last_column + right_of, f);
  const int plane = last_plane - first_plane + 1;
  const int begin_row = f * first_row_ - below, rows = f * last_row_ + above - begin_row + 1;
  const std::size_t stride = (static_cast<std::size_t>(plane) + 31) / 16 * 16;

  std::vector<float> fine(stride * f * rows, deepest);  // [row][phase][column]
  Grid<double> heights(f * plane, rows);
  Mask inside(f * plane, rows);
  double sum = 0;
  for (int y = first_row_; y <= last_row_; ++y)
    for (int x = spans_[y][0]; x <= spans_[y][1]; ++x)
      if (used_(x, y)) sum += image_.z_nm(x, y);
  // Floats store small numbers relative to it.
  const double middle = sum / static_cast<double>(used_pixels_);
  std::vector<float> lowest(rows, std::numeric_limits<float>::infinity()), highest(rows, deepest);
  parallel_for(rows, threads_, [&](std::size_t r, int) {
    const int row = static_cast<int>(r), global_row = begin_row + row;
    // The pixels that reach this row determine the columns needed.
    const int from = std::max(first_row_, floor_div(global_row - above + f - 1, f));
    const int to = std::min(last_row_, floor_div(global_row + below, f));
    int left = std::numeric_limits<int>::max(), right = std::numeric_limits<int>::min();
    for (int y = from; y <= to; ++y) {
      if (spans_[y][1] < 0) continue;
      left = std::min(left, f * spans_[y][0] - left_of);
      right = std::max(right, f * spans_[y][1] + right_of);
    }
    for (int global = left; global <= right; ++global) {
      const int column = global - f * first_plane;
      const Point2 p =
          map({image_.origin_x_nm + global * step_x, image_.origin_y_nm + global_row * step_y});
      double v;
      if (p.x >= 0 && p.y >= 0 && p.x <= frame_.width - 1 && p.y <= frame_.height - 1) {
        v = CubicSample(p.x, p.y, frame_.width, frame_.height).value(z);
        inside(column, row) = 1;
      } else if (global >= 0 && global_row >= 0 && global < outside_.width() &&
                 global_row < outside_.height()) {
        v = outside_(global, global_row);
      } else {
        continue;
      }
      heights(column, row) = v;
      const float small = static_cast<float>(v - middle);
      fine[(r * f + column % f) * stride + column / f] = small;
      lowest[r] = std::min(lowest[r], small);
      highest[r] = std::max(highest[r], small);
    }
  });
  const float floor = *std::min_element(lowest.begin(), lowest.end());

  parallel_for(last_row_ - first_row_ + 1, threads_, [&](std::size_t i, int) {
    const int y = first_row_ + static_cast<int>(i), left = spans_[y][0],
              count = spans_[y][1] - left + 1;
    if (count <= 0) return;
    thread_local std::vector<float> made;
    thread_local std::vector<std::int32_t> touching;
    made.assign(count, deepest);
    touching.assign(count, -1);
    for (int j = 0; j < th; ++j) {
      const int row = f * y - (j - tip.apex_y) - begin_row;
      for (int k = 0; k < tw; ++k) {
        const float offset = static_cast<float>(tip.z_nm(k, j));
        // Skips a tip sample so deep that even the highest surface sample of the row stays below
        // the contact of the apex with the lowest one.
        if (offset + highest[row] < floor) continue;
        const int column = f * left - (k - tip.apex_x) - f * first_plane;
        HWY_DYNAMIC_DISPATCH(raise)
        (made.data(), touching.data(),
         fine.data() + (static_cast<std::size_t>(row) * f + column % f) * stride + column / f,
         offset, j * tw + k, count);
      }
    }
    for (int c = 0; c < count; ++c) {
      const int x = left + c;
      if (!used_(x, y) || touching[c] < 0) continue;
      const int j = touching[c] / tw, k = touching[c] % tw;
      const int global = f * x - (k - tip.apex_x), global_row = f * y - (j - tip.apex_y);
      const int column = global - f * first_plane, row = global_row - begin_row;
      s.simulated(x, y) = heights(column, row) + tip.z_nm(k, j);
      s.residual(x, y) = image_.z_nm(x, y) - s.simulated(x, y);
      Contact& contact = s.contacts[static_cast<std::size_t>(y) * w + x];
      contact.tip_sample = touching[c];
      contact.inside = inside(column, row);
      const Point2 nm{image_.origin_x_nm + global * step_x,
                      image_.origin_y_nm + global_row * step_y},
          p = map(nm);
      contact.x = p.x;
      contact.y = p.y;
      contact.from_middle_x = (nm.x - middle_.x) / reach_nm_;
      contact.from_middle_y = (nm.y - middle_.y) / reach_nm_;
    }
  });
  s.value = -log_likelihood(s.residual, noise_, used_, &s.pull);
  // The sign of `pull` is right: d(-log p)/d simulated = d(log p)/d residual, because the residual
  // falls as the simulated pixel rises.
  return s;
}

void AfmTerm::add_gradient(const State& s, const Grid<double>& z, const Grid<double>& weights,
                           Grid<double>& out, MapChange* map, TipChange* tip) const {
  struct Sums {
    MapChange map{};
    TipChange tip{};
  };
  std::array<Sums, chunks> sums{};
  if (map || tip)
    in_chunks(s.contacts.size(), threads_,
              [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                Sums sum;
                for (std::size_t i = begin; i < end; ++i) {
                  const Contact& c = s.contacts[i];
                  const double weight = weights.data()[i];
                  if (tip && c.tip_sample >= 0)
                    for (int k = 0; k < tip_numbers; ++k)
                      sum.tip[k] += weight * s.by_tip[c.tip_sample][k];
                  if (!map || !c.inside || weight == 0) continue;
                  const CubicSample at(c.x, c.y, frame_.width, frame_.height);
                  const double sx = weight * at.slope_x(z), sy = weight * at.slope_y(z);
                  sum.map[0] += sx;
                  sum.map[1] += sx * c.from_middle_x;
                  sum.map[2] += sx * c.from_middle_y;
                  sum.map[3] += sy;
                  sum.map[4] += sy * c.from_middle_x;
                  sum.map[5] += sy * c.from_middle_y;
                  sum.map[6] += sx * drift_share(c.from_middle_y);
                  sum.map[7] += sy * drift_share(c.from_middle_y);
                }
                sums[chunk] = sum;
              });
  for (const Sums& sum : sums) {
    for (int k = 0; map && k < map_numbers; ++k) (*map)[k] += sum.map[k];
    for (int k = 0; tip && k < tip_numbers; ++k) (*tip)[k] += sum.tip[k];
  }
  // Contacts of several pixels may lie on one sample.
  for (std::size_t i = 0; i < s.contacts.size(); ++i) {
    const Contact& c = s.contacts[i];
    const double weight = weights.data()[i];
    if (c.inside && weight != 0)
      CubicSample(c.x, c.y, frame_.width, frame_.height).scatter(weight, out);
  }
}

Grid<double> AfmTerm::change(const State& s, const Grid<double>& z, const Grid<double>& dz,
                             const MapChange& map, const TipChange& tip) const {
  Grid<double> out(image_.z_nm.width(), image_.z_nm.height());
  const bool moves = std::any_of(map.begin(), map.end(), [](double m) { return m != 0; });
  in_chunks(s.contacts.size(), threads_, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Contact& c = s.contacts[i];
      double v = 0;
      if (c.tip_sample >= 0)
        for (int k = 0; k < tip_numbers; ++k) v += tip[k] * s.by_tip[c.tip_sample][k];
      if (c.inside) {
        const CubicSample at(c.x, c.y, frame_.width, frame_.height);
        v += at.value(dz);
        if (moves)
          v += at.slope_x(z) * (map[0] + map[1] * c.from_middle_x + map[2] * c.from_middle_y +
                                map[6] * drift_share(c.from_middle_y)) +
               at.slope_y(z) * (map[3] + map[4] * c.from_middle_x + map[5] * c.from_middle_y +
                                map[7] * drift_share(c.from_middle_y));
      }
      out.data()[i] = v;
    }
  });
  return out;
}

Grid<double> AfmTerm::precision(const Grid<double>& v) const {
  Grid<double> gradient;
  log_likelihood(v, noise_, used_, &gradient);
  for (double& g : gradient.data()) g = -g;
  return gradient;
}

}  // namespace surf::reconstruction
#endif
