// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/height_field_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/argument.h"
#include "surf/core/error.h"
#include "surf/mesh/sheet_solid.h"

namespace surf {
namespace {

constexpr double max_samples = std::numeric_limits<std::uint32_t>::max() / 2;

/// Triangles over a width x height raster of vertices numbered row by row.
std::vector<Triangle> raster_triangles(std::uint32_t width, std::uint32_t height) {
  std::vector<Triangle> triangles;
  triangles.reserve(std::size_t{2} * (width - 1) * (height - 1));
  for (std::uint32_t row = 0; row + 1 < height; ++row) {
    for (std::uint32_t column = 0; column + 1 < width; ++column) {
      const std::uint32_t a = row * width + column;
      triangles.push_back({a, a + 1, a + width + 1});
      triangles.push_back({a, a + width + 1, a + width});
    }
  }
  return triangles;
}

int continued_index(int index, int count, Edge edge) {
  const auto wrap = [index](int period) { return (index % period + period) % period; };
  switch (edge) {
    case Edge::flat:
      return std::clamp(index, 0, count - 1);
    case Edge::periodic:
      return wrap(count);
    case Edge::mirror: {
      const int period = 2 * (count - 1);
      const int folded = wrap(period);
      return std::min(folded, period - folded);
    }
  }
  throw UsageError("edge", "it is none of mirror, flat and periodic", "Give one of them");
}

/// The index of the sample for each of `margin + count + margin` samples.
std::vector<int> continued_indices(int count, int margin, Edge edge) {
  std::vector<int> indices(static_cast<std::size_t>(count + 2 * margin));
  for (int i = 0; i < count + 2 * margin; ++i) {
    indices[static_cast<std::size_t>(i)] = continued_index(i - margin, count, edge);
  }
  return indices;
}

/// The number of whole pitches that cover the margin. A rounding error above a whole number adds
/// none.
double margin_pitches(double margin_nm, double pitch_nm) {
  return std::ceil(margin_nm / pitch_nm * (1 - 1e-12));
}

template <class T>
Grid<T> picked(const Grid<T>& grid, const std::vector<int>& columns, const std::vector<int>& rows) {
  Grid<T> result(static_cast<int>(columns.size()), static_cast<int>(rows.size()));
  std::size_t i = 0;
  for (const int row : rows) {
    for (const int column : columns) result.data()[i++] = grid(column, row);
  }
  return result;
}

}  // namespace

void require_no_holes(const HeightField& field) {
  validate(field);
  for (int row = 0; row < field.z_nm.height(); ++row) {
    for (int column = 0; column < field.z_nm.width(); ++column) {
      if (field.is_valid(column, row)) continue;
      throw InvalidInput(
          "height field", fmt::format("the sample at column {}, row {} is invalid", column, row),
          "A surface has no holes: crop, or fill them (semsurf clean --spikes 9:1um --fill-holes, "
          "which leaves all other heights)");
    }
  }
  if (static_cast<double>(field.z_nm.size()) > max_samples) {
    throw Unsupported("height field", fmt::format("it has {} samples", field.z_nm.size()),
                      "Crop it or lower its resolution");
  }
}

TriangleMesh height_field_sheet(const HeightField& field) {
  require_no_holes(field);
  const int width = field.z_nm.width();
  const int height = field.z_nm.height();
  TriangleMesh mesh;
  mesh.vertices_nm.reserve(field.z_nm.size());
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      mesh.vertices_nm.push_back({field.x_nm(column), field.y_nm(row), field.z_nm(column, row)});
    }
  }
  mesh.triangles =
      raster_triangles(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  return mesh;
}

HeightField extend_height_field(const HeightField& field, double margin_x_nm, double margin_y_nm,
                                Edge edge) {
  validate(field);
  require_not_negative(margin_x_nm, "margin along x");
  require_not_negative(margin_y_nm, "margin along y");
  const int width = field.z_nm.width();
  const int height = field.z_nm.height();
  const double extra_x = margin_pitches(margin_x_nm, field.pitch_x_nm);
  const double extra_y = margin_pitches(margin_y_nm, field.pitch_y_nm);
  if (!((width + 2 * extra_x) * (height + 2 * extra_y) <= max_samples)) {
    throw UsageError(
        "margin",
        fmt::format("{} x {} nm around the field makes {:.4g} x {:.4g} samples", margin_x_nm,
                    margin_y_nm, width + 2 * extra_x, height + 2 * extra_y),
        "Give a smaller margin or a field of wider pitch");
  }

  const int margin_x = static_cast<int>(extra_x);
  const int margin_y = static_cast<int>(extra_y);
  const std::vector<int> columns = continued_indices(width, margin_x, edge);
  const std::vector<int> rows = continued_indices(height, margin_y, edge);
  HeightField result;
  result.z_nm = picked(field.z_nm, columns, rows);
  if (!field.valid.empty()) result.valid = Mask(picked(field.valid, columns, rows));
  result.pitch() = field.pitch();
  result.origin_x_nm = field.x_nm(-margin_x);
  result.origin_y_nm = field.y_nm(-margin_y);
  return result;
}

TriangleMesh half_space_top(const HeightField& field, double apron_nm) {
  require_positive(apron_nm, "apron");
  require_no_holes(field);
  // Adds a ring of samples with the outermost heights and moves it from one pitch out to the apron.
  HeightField ringed = extend_height_field(field, field.pitch_x_nm, field.pitch_y_nm, Edge::flat);
  TriangleMesh mesh = height_field_sheet(ringed);
  const int width = ringed.z_nm.width();
  const int height = ringed.z_nm.height();
  const auto moved = [&](double first, double last, int index, int count, double inside) {
    if (index == 0) return first - apron_nm;
    return index == count - 1 ? last + apron_nm : inside;
  };
  std::size_t i = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      Vec3& v = mesh.vertices_nm[i++];
      v.x = moved(field.x_nm(0), field.x_nm(width - 3), column, width, field.x_nm(column - 1));
      v.y = moved(field.y_nm(0), field.y_nm(height - 3), row, height, field.y_nm(row - 1));
    }
  }
  return mesh;
}

TriangleMesh height_field_solid(const HeightField& field, double base_z_nm) {
  return sheet_solid(height_field_sheet(field), base_z_nm);
}

}  // namespace surf
