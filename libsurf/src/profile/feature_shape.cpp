// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/feature_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double arc_step_deg = 10;
constexpr int segments_of_a_hole = 96;
constexpr std::array<const char*, 4> names{"line", "trench", "edge", "hole"};

void check(const WallShape& w) {
  const auto in = [](double v, double low, double high) { return v >= low && v <= high; };
  if (!(w.height_nm > 0 && std::isfinite(w.height_nm)))
    throw InvalidInput("wall", fmt::format("its height is {} nm", w.height_nm), "Give more than 0");
  if (!in(w.angle_deg, 30, 150))
    throw InvalidInput("wall", fmt::format("its angle is {} degrees", w.angle_deg),
                       "Give 30 to 150");
  if (!in(w.top_radius_nm, 0, 1e6) || !in(w.foot_radius_nm, 0, 1e6))
    throw InvalidInput("wall", "a radius is negative or not finite", "Give 0 or more");
}

/// The length of flank that an arc takes.
double taken(double radius_nm, double angle) { return radius_nm * std::tan(0.5 * angle); }

int steps_of(double angle) {
  return std::max(1, static_cast<int>(std::ceil(angle / degree / arc_step_deg)));
}

/// Points (x, z) of the cross-section from left to right.
std::vector<Point2> cross_section(const FeatureShape& s, double reach_nm) {
  const std::vector<Point2> wall = wall_profile(s.wall);
  const WallExtent extent = wall_extent(s.wall);
  const bool line = s.kind == FeatureKind::line;
  const double half = 0.5 * s.width_nm, h = s.wall.height_nm;
  const double gap = s.pitch_nm - s.width_nm;
  // Of a line the material is within the width; of a trench the ground.
  const double within = line ? extent.top_nm : extent.ground_nm,
               beyond = line ? extent.ground_nm : extent.top_nm;
  if (s.kind != FeatureKind::edge && !(half > within))
    throw InvalidInput("feature", fmt::format("its walls meet: it is {:g} nm wide", s.width_nm),
                       "Give a larger width, or walls that are lower or steeper");
  if (s.pitch_nm > 0 && !(0.5 * gap > beyond))
    throw InvalidInput("feature",
                       fmt::format("walls of neighbours meet at a pitch of {:g} nm", s.pitch_nm),
                       "Give a larger pitch or a smaller width");
  std::vector<Point2> points;
  const auto rising = [&](double at) {
    for (const Point2& p : wall) points.push_back({at + p.x, p.y});
  };
  const auto falling = [&](double at) {
    for (auto p = wall.rbegin(); p != wall.rend(); ++p) points.push_back({at - p->x, p->y});
  };
  const double far = reach_nm + half + std::max(extent.ground_nm, extent.top_nm);
  if (s.kind == FeatureKind::edge) {
    points.push_back({-far, 0});
    rising(0);
    points.push_back({far, h});
    return points;
  }
  const int each_side =
      s.pitch_nm > 0 ? static_cast<int>(std::ceil((reach_nm + half) / s.pitch_nm)) : 0;
  const double outside = line ? 0 : h, end = each_side * s.pitch_nm + far;
  points.push_back({-end, outside});
  for (int i = -each_side; i <= each_side; ++i) {
    const double middle = i * s.pitch_nm;
    if (line) rising(middle - half), falling(middle + half);
    else falling(middle - half), rising(middle + half);
  }
  points.push_back({end, outside});
  return points;
}

/// The section with x rising from point to point: seen from above, a sheet's rim must not fold.
std::vector<Point2> unfolded(std::vector<Point2> section) {
  constexpr double least_nm = 0.01;
  for (std::size_t i = 1; i < section.size(); ++i)
    section[i].x = std::max(section[i].x, section[i - 1].x + least_nm);
  return section;
}

TriangleMesh extruded(const std::vector<Point2>& section, double reach_nm) {
  constexpr double rim_nm = 10;
  const std::vector<Point2> rim = unfolded(section);
  TriangleMesh mesh;
  const auto add = [&](double y, const std::vector<Point2>& points) {
    for (const Point2& p : points) mesh.vertices_nm.push_back({p.x, y, p.y});
  };
  add(-reach_nm - rim_nm, rim), add(-reach_nm, section), add(reach_nm, section),
      add(reach_nm + rim_nm, rim);
  const auto n = static_cast<std::uint32_t>(section.size());
  for (std::uint32_t row = 0; row < 3 * n; row += n)
    for (std::uint32_t i = row; i + 1 < row + n; ++i) {
      mesh.triangles.push_back({i, i + 1, n + i + 1});
      mesh.triangles.push_back({i, n + i + 1, n + i});
    }
  return mesh;
}

/// The wall of a hole, turned about its axis.
TriangleMesh revolved(const FeatureShape& s, double reach_nm) {
  const std::vector<Point2> wall = wall_profile(s.wall);
  const WallExtent extent = wall_extent(s.wall);
  const double radius = 0.5 * s.width_nm;
  if (!(radius > extent.ground_nm))
    throw InvalidInput("feature", fmt::format("its walls meet: it is {:g} nm wide", s.width_nm),
                       "Give a larger width, or walls that are lower or steeper");
  TriangleMesh mesh;
  std::vector<Point2> rings;
  for (const Point2& p : wall) rings.push_back({radius + p.x, p.y});
  rings.push_back({radius + extent.top_nm + reach_nm, s.wall.height_nm});
  mesh.vertices_nm.push_back({0, 0, 0});
  for (const Point2& ring : rings)
    for (int k = 0; k < segments_of_a_hole; ++k) {
      const double a = 2 * std::numbers::pi * k / segments_of_a_hole;
      mesh.vertices_nm.push_back({ring.x * std::cos(a), ring.x * std::sin(a), ring.y});
    }
  constexpr auto n = static_cast<std::uint32_t>(segments_of_a_hole);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({0, 1 + k, 1 + next});
    for (std::uint32_t r = 0; r + 1 < rings.size(); ++r) {
      const std::uint32_t inner = 1 + r * n, outer = inner + n;
      mesh.triangles.push_back({inner + k, outer + k, outer + next});
      mesh.triangles.push_back({inner + k, outer + next, inner + next});
    }
  }
  return mesh;
}

}  // namespace

std::vector<Point2> wall_profile(const WallShape& w) {
  check(w);
  const double a = w.angle_deg * degree, h = w.height_nm;
  const double top = taken(w.top_radius_nm, a), foot = taken(w.foot_radius_nm, a);
  if (!(top + foot <= h / std::sin(a)))
    throw InvalidInput("wall",
                       fmt::format("corners of {:g} and {:g} nm need more flank than {:g} nm of "
                                   "height have",
                                   w.top_radius_nm, w.foot_radius_nm, h),
                       "Give smaller radii");
  const double cot = std::cos(a) / std::sin(a);
  const Point2 foot_corner{-0.5 * h * cot, 0}, top_corner{0.5 * h * cot, h};
  std::vector<Point2> points;
  const int steps = steps_of(a);
  if (w.foot_radius_nm > 0)
    for (int i = 0; i <= steps; ++i) {
      const double phi = a * i / steps;
      points.push_back({foot_corner.x - foot + w.foot_radius_nm * std::sin(phi),
                        w.foot_radius_nm * (1 - std::cos(phi))});
    }
  else points.push_back(foot_corner);
  if (w.top_radius_nm > 0)
    for (int i = 0; i <= steps; ++i) {
      const double phi = a * (1 - static_cast<double>(i) / steps);
      points.push_back({top_corner.x + top - w.top_radius_nm * std::sin(phi),
                        h - w.top_radius_nm * (1 - std::cos(phi))});
    }
  else points.push_back(top_corner);
  return points;
}

WallExtent wall_extent(const WallShape& wall) {
  double low = 0, high = 0;
  for (const Point2& p : wall_profile(wall)) low = std::min(low, p.x), high = std::max(high, p.x);
  return {-low, high};
}

TriangleMesh feature_mesh(const FeatureShape& shape, double reach_nm) {
  if (!(reach_nm > 0 && std::isfinite(reach_nm)))
    throw InvalidInput("feature", "its surroundings have no size", "Give more than 0");
  if (!(shape.width_nm > 0) && shape.kind != FeatureKind::edge)
    throw InvalidInput("feature", fmt::format("its width is {} nm", shape.width_nm),
                       "Give more than 0");
  if (shape.kind == FeatureKind::hole) return revolved(shape, reach_nm);
  return extruded(cross_section(shape, reach_nm), reach_nm);
}

const char* name(FeatureKind kind) { return names[static_cast<std::size_t>(kind)]; }

FeatureKind parse_feature_kind(const std::string& text, const std::string& subject) {
  const auto found = std::ranges::find(names, text);
  if (found == names.end())
    throw UsageError(subject, fmt::format("'{}' is no kind of feature", text),
                     "Give line, trench, edge or hole");
  return static_cast<FeatureKind>(found - names.begin());
}

}  // namespace surf
