// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/height_profile.h"

#include <cmath>
#include <limits>

#include "surf/core/error.h"
#include "surf/mesh/mesh_height_field.h"

namespace surf {

std::vector<double> height_profile(const TriangleMesh& mesh, Point2 from_nm, Point2 to_nm,
                                   int samples) {
  const double length = std::hypot(to_nm.x - from_nm.x, to_nm.y - from_nm.y);
  if (!(length > 0) || !std::isfinite(length))
    throw UsageError("line", "its ends are one point", "Choose two points that differ in x or y");
  if (samples < 2) throw UsageError("samples", "a profile has two or more", "Ask for 500, say");
  // Rotates the line onto the x axis, where it is the lowest row of a height field.
  const double c = (to_nm.x - from_nm.x) / length, s = (to_nm.y - from_nm.y) / length;
  TriangleMesh turned = mesh;
  for (Vec3& v : turned.vertices_nm) {
    const double x = v.x - from_nm.x, y = v.y - from_nm.y;
    v = {c * x + s * y, c * y - s * x, v.z};
  }
  MeshHeightFieldOptions options;
  options.pitch_nm = length / (samples - 1);
  options.region_nm.emplace();
  options.region_nm->extend(Vec3{0, 0, 0});
  options.region_nm->extend(Vec3{length, options.pitch_nm, 0});
  const HeightField field = mesh_height_field(turned, options);
  std::vector<double> heights(static_cast<std::size_t>(samples),
                              std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < samples && i < field.z_nm.width(); ++i)
    if (field.is_valid(i, 0)) heights[static_cast<std::size_t>(i)] = field.z_nm(i, 0);
  return heights;
}

}  // namespace surf
