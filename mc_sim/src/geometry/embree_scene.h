// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/vec3.h"
#include "surf/mc/geometry/scene_mesh.h"

namespace surf::mc {

/// All triangles that a path can meet; none: not known.
using KnownFaces = std::optional<std::span<const std::uint32_t>>;

/// Nearest triangles along rays. Embree proposes hits in single precision, about the mesh's centre;
/// each one is recomputed in double on the source triangle, to a point exactly on it.
class EmbreeScene {
 public:
  struct Hit {
    double distance = 0;  ///< along the ray, >= 0
    Vec3 position;        ///< on the triangle
    Vec3 normal;          ///< unit, the triangle's own sense
    std::uint32_t triangle = 0;
  };

  /// Decides whether a proposed triangle counts. `cosine` is between the ray and the triangle's
  /// normal, never 0; `distance` is to the triangle's plane, in double: negative behind the origin.
  using Accept = bool (*)(void* user, std::uint32_t triangle, double cosine, double distance);

  explicit EmbreeScene(SceneMesh mesh, const Watch& watch = {});  ///< throws Interrupted
  explicit EmbreeScene(TriangleMesh mesh, const Watch& watch = {});
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// The nearest accepted triangle within `length` of `origin`. The search starts a rounding error
  /// before the origin, so that a surface the origin lies on is never missed; `accept` turns
  /// down what was crossed already. `nudge` displaces the search alone, not the hit.
  bool nearest(const Vec3& origin, const Vec3& direction, double length, Accept accept, void* user,
               Hit& hit, const Vec3& nudge = {}) const;

  /// The same among `faces` alone, in double throughout: for short ways whose triangles are known.
  bool nearest_of(std::span<const std::uint32_t> faces, const Vec3& origin, const Vec3& direction,
                  double length, Accept accept, void* user, Hit& hit) const;

  /// Appends all triangles within `radius` of a point, and maybe some that are not. False, and
  /// nothing is known, where there would be more than `most`.
  bool within(const Vec3& point, double radius, std::size_t most,
              std::vector<std::uint32_t>& out) const;

  const MeshView& mesh() const;

  /// The largest radius up to `most` within which all triangles about a point lie in the plane
  /// through it, but for `tolerance`, and belong to one shell; a little smaller where rounding asks
  /// for it, and where very many triangles would have to be looked at. With a zero normal no
  /// triangle does.
  double flat_radius(const Vec3& point, const Vec3& normal, double tolerance, double most,
                     std::span<const std::uint32_t> shell_of) const;

  /// The largest coordinate of any vertex along a direction.
  double highest_along(const Vec3& direction) const;

  /// How far before its origin a ray starts: 1e-3 nm and the rounding of single precision.
  double tolerance_nm() const;

  std::size_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace surf::mc
