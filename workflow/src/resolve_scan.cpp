// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {
namespace {

constexpr int default_pixels = 256;
constexpr double whole_tolerance = 1e-6;  // relative, for a region that must hold whole pixels

struct Rectangle {
  double x0_nm, y0_nm, x1_nm, y1_nm;
  double width() const { return x1_nm - x0_nm; }
  double height() const { return y1_nm - y0_nm; }
};

[[noreturn]] void too_many_pixels(double width, double height) {
  throw UsageError("`scan.size`",
                   fmt::format("an image of {:.6g} x {:.6g} pixels is too large", width, height),
                   fmt::format("At most {} pixels (16384 x 16384) fit into one image: give fewer "
                               "or larger pixels, or a smaller region",
                               mc::max_pixels));
}

void check_request(const mc::ScanRequest& r) {
  if (r.width.has_value() != r.height.has_value())
    throw UsageError("`scan.size`", "only one of width and height is given",
                     "Write `scan.size=256x256`");
  if (r.pixel_x_nm.has_value() != r.pixel_y_nm.has_value())
    throw UsageError("`scan.pixel_size`", "only one of x and y is given",
                     "Write `scan.pixel_size=2nm`");
  if (r.width && r.pixel_x_nm && r.region)
    throw UsageError("`scan.size`, `scan.pixel_size`, `scan.region`",
                     "all three are given, and any two say it all", "Leave one out");
  if (r.width && (*r.width < 1 || *r.height < 1))
    throw UsageError("`scan.size`", fmt::format("{}x{} is not a size", *r.width, *r.height),
                     "Give at least 1x1 pixels");
  if (r.width && std::int64_t{*r.width} * *r.height > mc::max_pixels)
    too_many_pixels(*r.width, *r.height);
  if (r.pixel_x_nm)
    for (double pixel : {*r.pixel_x_nm, *r.pixel_y_nm})
      if (!(pixel > 0) || !std::isfinite(pixel))
        throw UsageError("`scan.pixel_size`", fmt::format("{} nm is not a pixel size", pixel),
                         "Give a length above zero");
  if (r.region) {
    const auto& g = *r.region;
    const bool finite = std::isfinite(g.x0_nm) && std::isfinite(g.y0_nm) &&
                        std::isfinite(g.x1_nm) && std::isfinite(g.y1_nm);
    if (!finite || !(g.x0_nm < g.x1_nm) || !(g.y0_nm < g.y1_nm))
      throw UsageError("`scan.region`", "the region is empty",
                       "Give the outer edges X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1");
  }
}

// The specimen's extent as seen by the beam, about its centre: the box's shadow on the scan's axes.
// These are x and y rotated with the beam by the smallest rotation from straight down.
Rectangle specimen_rectangle(const Box& extent, const mc::Beam& beam) {
  const Vec3 d = mc::direction(beam);
  const double k = 1 / (1 - d.z);
  const Vec3 across{1 - d.x * d.x * k, -d.x * d.y * k, d.x};
  const Vec3 up{-d.x * d.y * k, 1 - d.y * d.y * k, d.y};
  const Vec3 size = extent.size_nm(), center = extent.center_nm();
  const auto half_shadow = [&](const Vec3& axis) {
    return 0.5 * dot(Vec3{std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)}, size);
  };
  const double half_x = half_shadow(across), half_y = half_shadow(up);
  const Rectangle r{center.x - half_x, center.y - half_y, center.x + half_x, center.y + half_y};
  if (extent.empty() || !std::isfinite(r.width()) || !std::isfinite(r.height()) ||
      !(r.width() > 0) || !(r.height() > 0))
    throw UsageError("`scan.region`", "the specimen has no extent in x and y to choose a scan from",
                     "Give `scan.region` and `scan.size`");
  return r;
}

// The whole number of pixels along a length that the user gave together with the pixel size.
double whole_pixels(double length_nm, double pixel_nm, const char* axis) {
  const double pixels = length_nm / pixel_nm;
  const double whole = std::round(pixels);
  if (whole >= 1 && std::abs(pixels - whole) <= whole_tolerance * whole) return whole;
  const double fewer = std::max(1.0, std::floor(pixels));
  throw UsageError(
      "`scan.region`, `scan.pixel_size`",
      fmt::format("{} nm along {} is {:.7g} pixels of {} nm, not a whole number",
                  format_exact(length_nm), axis, pixels, format_exact(pixel_nm)),
      fmt::format("Give `scan.size` instead, or a pixel size of {:.9g} nm ({} pixels) or "
                  "{:.9g} nm ({} pixels)",
                  length_nm / fewer, fewer, length_nm / (fewer + 1), fewer + 1));
}

// The number of pixels that cover a length, rounded up, except for rounding errors.
double covering_pixels(double length_nm, double pixel_nm) {
  return std::max(1.0, std::ceil(length_nm / pixel_nm * (1 - 1e-9)));
}

struct Layout {
  double width, height;  // whole numbers, as double until they are known to fit an int
  double pixel_x_nm, pixel_y_nm;
};

Layout from_region(const mc::ScanRequest& request, const Rectangle& region) {
  if (request.width)
    return {double(*request.width), double(*request.height), region.width() / *request.width,
            region.height() / *request.height};
  if (request.pixel_x_nm)
    return {whole_pixels(region.width(), *request.pixel_x_nm, "x"),
            whole_pixels(region.height(), *request.pixel_y_nm, "y"), *request.pixel_x_nm,
            *request.pixel_y_nm};
  const double pixel = std::max(region.width(), region.height()) / default_pixels;
  const double nx = std::max(1.0, std::round(region.width() / pixel));
  const double ny = std::max(1.0, std::round(region.height() / pixel));
  return {nx, ny, region.width() / nx, region.height() / ny};
}

// Square pixels about the specimen's centre that show all of it, unless the user gave both.
Layout from_extent(const mc::ScanRequest& request, const Rectangle& extent) {
  if (request.width && request.pixel_x_nm)
    return {double(*request.width), double(*request.height), *request.pixel_x_nm,
            *request.pixel_y_nm};
  if (request.width) {
    const double pixel =
        std::max(extent.width() / *request.width, extent.height() / *request.height);
    return {double(*request.width), double(*request.height), pixel, pixel};
  }
  const double longer = std::max(extent.width(), extent.height());
  const double pixel_x = request.pixel_x_nm.value_or(longer / default_pixels);
  const double pixel_y = request.pixel_y_nm.value_or(longer / default_pixels);
  return {covering_pixels(extent.width(), pixel_x), covering_pixels(extent.height(), pixel_y),
          pixel_x, pixel_y};
}

}  // namespace

mc::Scan resolve_scan(const mc::ScanRequest& request, const Box& specimen_extent,
                      const mc::Beam& beam) {
  check_request(request);
  mc::validate(beam);
  const Rectangle around = request.region ? Rectangle{request.region->x0_nm, request.region->y0_nm,
                                                      request.region->x1_nm, request.region->y1_nm}
                                          : specimen_rectangle(specimen_extent, beam);
  const Layout layout =
      request.region ? from_region(request, around) : from_extent(request, around);
  if (!(layout.width * layout.height <= double(mc::max_pixels)))
    too_many_pixels(layout.width, layout.height);

  mc::Scan scan;
  scan.width = static_cast<int>(layout.width);
  scan.height = static_cast<int>(layout.height);
  scan.pixel_x_nm = layout.pixel_x_nm;
  scan.pixel_y_nm = layout.pixel_y_nm;
  scan.center_x_nm = 0.5 * (around.x0_nm + around.x1_nm);
  scan.center_y_nm = 0.5 * (around.y0_nm + around.y1_nm);
  if (!specimen_extent.empty()) scan.center_z_nm = specimen_extent.center_nm().z;
  mc::validate(scan);
  return scan;
}

}  // namespace surf::workflow
