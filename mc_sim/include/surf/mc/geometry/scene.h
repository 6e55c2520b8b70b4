// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/vec3.h"
#include "surf/mc/geometry/beam.h"
#include "surf/mc/geometry/scene_surfaces.h"
#include "surf/mc/geometry/specimen.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

/// How `Scene` is built.
struct SceneOptions {
  /// Memory for bounds of the distance to the nearest surface, bytes, about (>= 0; 0: none, every
  /// step asks for the surface). They change speed, not results.
  std::size_t distance_grid_bytes = std::size_t{32} << 20;
  Watch watch;
};

struct SceneSummary {
  std::size_t triangles = 0;           ///< as traced (with a height field's continuation)
  std::size_t triangles_left_out = 0;  ///< besides: out of every electron's reach
  std::size_t shells = 0;              ///< connected closed surfaces
  std::size_t memory_bytes = 0;        ///< triangles, ray-tracing structures, distance bounds
  double grid_cell_nm = 0;             ///< finest cells of the distance bounds; 0 without
  double build_seconds = 0;
};

/// A specimen, a beam, a scan and the physics, made ready for simulation: immutable, safe to use
/// from many threads.
class Scene {
 public:
  /// Validates and builds. A height field is continued as far as electrons from the scanned region
  /// reach, and the distance bounds cover that. Throws Interrupted.
  Scene(const Specimen& specimen, const Beam& beam, const Scan& scan, const Physics& physics = {},
        const SceneOptions& options = {});
  /// The same of surfaces that `make_surfaces` has made, here or in another process, for the same
  /// beam, scan and physics.
  Scene(SceneSurfaces surfaces, std::vector<Material> materials, const Beam& beam, const Scan& scan,
        const Physics& physics = {}, const SceneOptions& options = {});
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const Beam& beam() const;
  const Scan& scan() const;
  const Physics& physics() const;
  const std::vector<Material>& materials() const;
  const SceneSummary& summary() const;

  /// The first surface along a line through vacuum; false where it misses everything.
  bool first_surface(const Vec3& start_nm, const Vec3& direction, Vec3& hit_nm) const;

  /// A proven lower bound of the distance from a point to the nearest surface, nm (>= 0).
  double distance_bound_nm(const Vec3& point_nm) const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Version of the ray-tracing library, as built against.
std::string ray_tracer_version();

}  // namespace surf::mc
