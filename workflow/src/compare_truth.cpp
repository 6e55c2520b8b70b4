// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "edge_places.h"
#include "sem_frame.h"
#include "surf/afm/background.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

constexpr std::int64_t least_pixels = 16;

// As a tangent of the slope, like wall_slope.
constexpr double flat_below = 0.1;
constexpr int around_px = 3;

struct Differences {
  HeightField less;  // surface minus truth, valid where both are
  double middle = 0, rms = 0;
  std::int64_t count = 0;
};

Differences differences(const HeightField& surface, const HeightField& truth) {
  Differences d{surface, 0, 0, 0};
  d.less.valid = Mask(surface.z_nm.width(), surface.z_nm.height());
  std::vector<double> all;
  for (int y = 0; y < surface.z_nm.height(); ++y)
    for (int x = 0; x < surface.z_nm.width(); ++x) {
      if (!surface.is_valid(x, y) || !truth.is_valid(x, y)) continue;
      const double less = surface.z_nm(x, y) - truth.z_nm(x, y);
      d.less.z_nm(x, y) = less;
      d.less.valid(x, y) = 1;
      all.push_back(less);
    }
  d.count = static_cast<std::int64_t>(all.size());
  if (d.count < least_pixels)
    throw InvalidInput(
        "`reconstruction.truth`",
        fmt::format("it has {} places in common with the surface", d.count),
        "Give heights in the frame of the SEM image, or of the scan where there is none");
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::ranges::nth_element(all, middle);
  d.middle = *middle;
  double squared = 0;
  for (const double less : all) squared += (less - d.middle) * (less - d.middle);
  d.rms = std::sqrt(squared / static_cast<double>(d.count));
  return d;
}

double rms_of(const HeightField& field) {
  double squared = 0, count = 0;
  for (std::size_t i = 0; i < field.z_nm.size(); ++i)
    if (field.valid.data()[i]) squared += field.z_nm.data()[i] * field.z_nm.data()[i], ++count;
  return std::sqrt(squared / count);
}

/// The largest slope within some pixels of each.
Grid<double> largest_around(const Grid<double>& slope, int around) {
  Grid<double> along = slope, out = slope;
  const int w = slope.width(), h = slope.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int u = std::max(0, x - around); u <= std::min(w - 1, x + around); ++u)
        along(x, y) = std::max(along(x, y), slope(u, y));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      out(x, y) = along(x, y);
      for (int v = std::max(0, y - around); v <= std::min(h - 1, y + around); ++v)
        out(x, y) = std::max(out(x, y), along(x, v));
    }
  return out;
}

Grid<double> slopes_of(const HeightField& f) {
  const int w = f.z_nm.width(), h = f.z_nm.height();
  Grid<double> slope(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int x0 = std::max(0, x - 1), x1 = std::min(w - 1, x + 1), y0 = std::max(0, y - 1),
                y1 = std::min(h - 1, y + 1);
      if (x0 == x1 || y0 == y1) continue;
      slope(x, y) = std::hypot((f.z_nm(x1, y) - f.z_nm(x0, y)) / ((x1 - x0) * f.pitch_x_nm),
                               (f.z_nm(x, y1) - f.z_nm(x, y0)) / ((y1 - y0) * f.pitch_y_nm));
    }
  return slope;
}

/// First that of all pixels.
std::vector<RegionReport> regions_of(const Reconstruction& result, const HeightField& truth,
                                     const Differences& d) {
  std::vector<RegionReport> regions;
  for (const PixelRegion& in : pixel_regions(truth, result.data_support)) {
    RegionReport& region = regions.emplace_back();
    region.name = in.name;
    for (std::size_t i = 0; i < d.less.z_nm.size(); ++i) {
      if (!d.less.valid.data()[i] || !in.pixels.data()[i]) continue;
      const double less = d.less.z_nm.data()[i] - d.middle, off = std::abs(less),
                   deviation = result.deviation_nm.data()[i];
      ++region.pixels;
      region.rms_nm += off * off;
      region.stated_nm += deviation * deviation;
      region.coverage_1 += off <= deviation;
      region.coverage_2 += off <= 2 * deviation;
      if (result.lower_nm.empty()) continue;
      const double truth_nm = result.surface.z_nm.data()[i] - less;
      region.in_interval +=
          truth_nm >= result.lower_nm.data()[i] && truth_nm <= result.upper_nm.data()[i];
    }
  }
  for (RegionReport& region : regions) {
    const auto n = static_cast<double>(std::max<std::int64_t>(region.pixels, 1));
    region.rms_nm = std::sqrt(region.rms_nm / n);
    region.stated_nm = std::sqrt(region.stated_nm / n);
    region.coverage_1 /= n;
    region.coverage_2 /= n;
    region.in_interval /= n;
  }
  std::erase_if(regions, [](const RegionReport& r) { return r.pixels == 0; });
  return regions;
}

}  // namespace

std::vector<PixelRegion> pixel_regions(const HeightField& truth,
                                       const Grid<unsigned char>& data_support) {
  const Grid<double> slope = slopes_of(truth), around = largest_around(slope, around_px);
  std::vector<PixelRegion> out;
  for (const char* name : {"all", "flat", "wall", "foot", "untouched"})
    out.push_back({name, Mask(slope.width(), slope.height())});
  for (std::size_t i = 0; i < slope.size(); ++i) {
    const bool wall = slope.data()[i] > wall_slope;
    const bool in[] = {true, around.data()[i] < flat_below, wall,
                       !wall && around.data()[i] > wall_slope,
                       !data_support.empty() && (data_support.data()[i] & 1) == 0};
    for (std::size_t r = 0; r < out.size(); ++r) out[r].pixels.data()[i] = in[r];
  }
  return out;
}

HeightField truth_on(const HeightField& surface, const HeightField& truth) {
  PlacedImage place;
  place.values = surface.z_nm;
  place.placement() = surface.placement();
  SurfaceUnderSem under = surface_under_sem(truth, place, Affine{});
  under.surface.valid = under.known;
  return under.surface;
}

double rms_off(const HeightField& surface, const HeightField& truth) {
  return differences(surface, truth_on(surface, truth)).rms;
}

TruthReport compare_with_truth(const Reconstruction& result, const HeightField& truth) {
  const HeightField there = truth_on(result.surface, truth);
  Differences d = differences(result.surface, there);
  TruthReport report;
  report.rms_nm = d.rms;
  report.offset_nm = d.middle;
  report.pixels = d.count;
  if (result.start.z_nm.width() == there.z_nm.width() &&
      result.start.z_nm.height() == there.z_nm.height())
    report.start_rms_nm = differences(result.start, there).rms;
  if (!result.deviation_nm.empty()) {
    report.regions = regions_of(result, there, d);
    report.coverage_1 = report.regions.front().coverage_1;
    report.coverage_2 = report.regions.front().coverage_2;
    report.in_interval = report.regions.front().in_interval;
    report.regions.erase(report.regions.begin());
    const RegionReport edges = edge_places(result, there, d.middle);
    if (edges.pixels > 0) report.regions.push_back(edges);
  }
  subtract(d.less, fit_plane(d.less));
  report.plane_rms_nm = rms_of(d.less);
  return report;
}

}  // namespace surf::workflow
