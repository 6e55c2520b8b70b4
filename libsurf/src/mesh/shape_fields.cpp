// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/argument.h"
#include "mesh/flat_field.h"
#include "surf/core/error.h"

namespace surf {
namespace {

int sample_count(double length_nm, double pitch_nm, const char* subject) {
  require_positive(length_nm, subject);
  const double count = std::round(length_nm / pitch_nm) + 1;
  if (count >= 2 && count <= 65536) return static_cast<int>(count);
  throw UsageError(
      subject,
      fmt::format("{} nm at a pitch of {} nm makes {:.6g} samples", length_nm, pitch_nm, count),
      "Choose both so that there are 2 to 65536");
}

/// Distance of a sample from the middle of the field; exactly the same on both sides.
double from_middle(int index, int count, double pitch_nm) {
  return std::abs(index - 0.5 * (count - 1)) * pitch_nm;
}

/// 1 up to `half_width_nm` from the middle, falling to 0 over `run_nm`.
double ramp(double distance_nm, double half_width_nm, double run_nm) {
  return std::clamp(1 - (distance_nm - half_width_nm) / run_nm, 0.0, 1.0);
}

/// Sets every sample to height(column, row).
template <class Height>
void raise(HeightField& field, const Height& height) {
  for (int row = 0; row < field.z_nm.height(); ++row) {
    for (int column = 0; column < field.z_nm.width(); ++column) {
      field.z_nm(column, row) = height(column, row);
    }
  }
}

}  // namespace

HeightField flat_field(const FieldExtent& extent) {
  require_positive(extent.pitch_nm, "pitch");
  const int width = sample_count(extent.width_nm, extent.pitch_nm, "width");
  const int height = sample_count(extent.depth_nm, extent.pitch_nm, "depth");
  constexpr std::int64_t most = std::int64_t{1} << 28;
  if (std::int64_t{width} * height > most)
    throw UsageError("extent", fmt::format("{} x {} samples are more than 2^28", width, height),
                     "Choose a smaller field or a larger pitch");
  HeightField field;
  field.z_nm = Grid<double>(width, height);
  field.pitch_x_nm = field.pitch_y_nm = extent.pitch_nm;
  field.origin_x_nm = -0.5 * (width - 1) * extent.pitch_nm;
  field.origin_y_nm = -0.5 * (height - 1) * extent.pitch_nm;
  return field;
}

HeightField make_mesa(const FieldExtent& extent, double height_nm, double top_width_nm,
                      double wall_run_nm) {
  require_positive(height_nm, "height of the mesa");
  require_positive(top_width_nm, "top width of the mesa");
  require_not_negative(wall_run_nm, "wall run of the mesa");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  Grid<double>& z = field.z_nm;
  for (int row = 0; row < z.height(); ++row) {
    for (int column = 0; column < z.width(); ++column) {
      const double distance_nm = std::max(from_middle(column, z.width(), extent.pitch_nm),
                                          from_middle(row, z.height(), extent.pitch_nm));
      z(column, row) = height_nm * ramp(distance_nm, 0.5 * top_width_nm, run_nm);
    }
  }
  return field;
}

HeightField make_trench(const FieldExtent& extent, double depth_nm, double bottom_width_nm,
                        double wall_run_nm) {
  require_positive(depth_nm, "depth of the trench");
  require_positive(bottom_width_nm, "bottom width of the trench");
  require_not_negative(wall_run_nm, "wall run of the trench");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  Grid<double>& z = field.z_nm;
  for (int row = 0; row < z.height(); ++row) {
    for (int column = 0; column < z.width(); ++column) {
      const double distance_nm = from_middle(column, z.width(), extent.pitch_nm);
      z(column, row) = 0.0 - depth_nm * ramp(distance_nm, 0.5 * bottom_width_nm, run_nm);
    }
  }
  return field;
}

HeightField make_line(const FieldExtent& extent, double height_nm, double top_width_nm,
                      double wall_run_nm) {
  require_positive(height_nm, "height of the line");
  require_positive(top_width_nm, "top width of the line");
  require_not_negative(wall_run_nm, "wall run of the line");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  raise(field, [&](int column, int) {
    const double distance_nm = from_middle(column, field.z_nm.width(), extent.pitch_nm);
    return height_nm * ramp(distance_nm, 0.5 * top_width_nm, run_nm);
  });
  return field;
}

HeightField make_via(const FieldExtent& extent, double depth_nm, double bottom_width_nm,
                     double wall_run_nm) {
  require_positive(depth_nm, "depth of the via");
  require_positive(bottom_width_nm, "bottom width of the via");
  require_not_negative(wall_run_nm, "wall run of the via");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  raise(field, [&](int column, int row) {
    const double distance_nm = std::hypot(from_middle(column, field.z_nm.width(), extent.pitch_nm),
                                          from_middle(row, field.z_nm.height(), extent.pitch_nm));
    return 0.0 - depth_nm * ramp(distance_nm, 0.5 * bottom_width_nm, run_nm);
  });
  return field;
}

HeightField make_step(const FieldExtent& extent, double height_nm, double wall_run_nm) {
  require_positive(height_nm, "height of the step");
  require_not_negative(wall_run_nm, "wall run of the step");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  raise(field, [&](int column, int) {
    const double x_nm = (column - 0.5 * (field.z_nm.width() - 1)) * extent.pitch_nm;
    return height_nm * std::clamp(0.5 + x_nm / run_nm, 0.0, 1.0);
  });
  return field;
}

HeightField make_grating(const FieldExtent& extent, double height_nm, double period_nm,
                         double top_width_nm, double wall_run_nm) {
  require_positive(height_nm, "height of the grating");
  require_positive(period_nm, "period of the grating");
  require_positive(top_width_nm, "top width of the grating");
  require_not_negative(wall_run_nm, "wall run of the grating");
  HeightField field = flat_field(extent);
  const double run_nm = wall_run_nm > 0 ? wall_run_nm : extent.pitch_nm;
  if (!(period_nm > top_width_nm + 2 * run_nm)) {
    throw UsageError("period of the grating",
                     fmt::format("{} nm, and the lines are {} nm wide at the foot", period_nm,
                                 top_width_nm + 2 * run_nm),
                     "Give a longer period or narrower lines");
  }
  raise(field, [&](int column, int) {
    const double x_nm = from_middle(column, field.z_nm.width(), extent.pitch_nm);
    return height_nm * ramp(std::abs(std::remainder(x_nm, period_nm)), 0.5 * top_width_nm, run_nm);
  });
  return field;
}

}  // namespace surf
