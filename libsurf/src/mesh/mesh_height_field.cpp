// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/mesh_height_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/argument.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr int rows_per_unit = 32;
constexpr int max_samples_a_side = 65536;
constexpr double slack = 1e-9;  // of barycentric coordinates

int sample_count(double length_nm, double pitch_nm, const char* subject) {
  const double count = std::round(length_nm / pitch_nm) + 1;
  if (count >= 2 && count <= max_samples_a_side) return static_cast<int>(count);
  throw UsageError(
      subject,
      fmt::format("{} nm at a pitch of {} nm makes {:.6g} samples", length_nm, pitch_nm, count),
      fmt::format("Choose both so that there are 2 to {}", max_samples_a_side));
}

HeightField empty_field(const TriangleMesh& mesh, const MeshHeightFieldOptions& options) {
  const Box region = options.region_nm.value_or(bounds(mesh));
  for (const double x :
       {region.lower_nm.x, region.lower_nm.y, region.upper_nm.x, region.upper_nm.y}) {
    require_finite(x, "region");
  }
  HeightField field;
  field.pitch_x_nm = field.pitch_y_nm = options.pitch_nm;
  field.origin_x_nm = region.lower_nm.x;
  field.origin_y_nm = region.lower_nm.y;
  const Vec3 size = region.size_nm();
  const int width = sample_count(size.x, options.pitch_nm, "width of the region");
  const int height = sample_count(size.y, options.pitch_nm, "depth of the region");
  field.z_nm = Grid<double>(width, height, -std::numeric_limits<double>::infinity());
  return field;
}

/// The range of samples between two coordinates, limited to the field.
struct Range {
  int first, last;
};
Range samples(double low, double high, double origin, double pitch, int count) {
  const double margin = slack * (high - low + pitch);
  const double first = std::ceil((low - margin - origin) / pitch);
  const double last = std::floor((high + margin - origin) / pitch);
  return {static_cast<int>(std::clamp(first, 0.0, double(count))),
          static_cast<int>(std::clamp(last, -1.0, double(count - 1)))};
}

/// Raises the samples below a triangle, in rows [first_row, last_row], to its height.
void raise(HeightField& field, const Vec3& a, const Vec3& b, const Vec3& c, int first_row,
           int last_row) {
  const double twice_area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  const double longest =
      std::max({std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - a.x, c.y - a.y),
                std::hypot(c.x - b.x, c.y - b.y)});
  if (std::abs(twice_area) <= 1e-12 * longest * longest) return;  // vertical triangle
  const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
  const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
  const auto [low_z, high_z] = std::minmax({a.z, b.z, c.z});
  const Range columns =
      samples(low_x, high_x, field.origin_x_nm, field.pitch_x_nm, field.z_nm.width());
  const Range rows =
      samples(low_y, high_y, field.origin_y_nm, field.pitch_y_nm, field.z_nm.height());
  for (int row = std::max(rows.first, first_row); row <= std::min(rows.last, last_row); ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const double x = field.x_nm(column), y = field.y_nm(row);
      const double v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / twice_area;
      const double w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / twice_area;
      if (v < -slack || w < -slack || v + w > 1 + slack) continue;
      const double z = std::clamp(a.z + v * (b.z - a.z) + w * (c.z - a.z), low_z, high_z);
      field.z_nm(column, row) = std::max(field.z_nm(column, row), z);
    }
  }
}

}  // namespace

HeightField mesh_height_field(const TriangleMesh& mesh, const MeshHeightFieldOptions& options) {
  require_positive(options.pitch_nm, "pitch");
  validate(mesh);
  options.watch.report(0, 1);
  HeightField field = empty_field(mesh, options);
  const int height = field.z_nm.height();
  parallel_for(
      static_cast<std::size_t>((height + rows_per_unit - 1) / rows_per_unit), options.threads,
      [&](std::size_t unit, int) {
        const int first = static_cast<int>(unit) * rows_per_unit;
        const int last = std::min(height, first + rows_per_unit) - 1;
        for (const auto& [a, b, c] : mesh.triangles) {
          raise(field, mesh.vertices_nm[a], mesh.vertices_nm[b], mesh.vertices_nm[c], first, last);
        }
      },
      options.watch);
  std::size_t covered = 0;
  Mask valid(field.z_nm.width(), height, 1);
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (std::isfinite(field.z_nm.data()[i])) {
      ++covered;
      continue;
    }
    field.z_nm.data()[i] = 0;
    valid.data()[i] = 0;
  }
  if (covered == 0) {
    throw InvalidInput("mesh", "no sample lies below or above it",
                       "Give a region that it covers, or a smaller pitch");
  }
  if (covered < valid.size()) field.valid = std::move(valid);
  return field;
}

}  // namespace surf
