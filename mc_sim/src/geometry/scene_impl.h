// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/distance_grid.h"
#include "geometry/embree_scene.h"
#include "geometry/geometry.h"
#include "geometry/horizon_map.h"
#include "geometry/reachability.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {

struct Scene::Impl {
  Beam beam;
  Scan scan;
  Physics physics;
  std::vector<Material> materials;
  std::vector<Medium> media;
  std::vector<const Medium*> medium_pointers;
  SceneSummary summary;

  std::vector<Solid> solids;
  std::vector<Shell> shells;
  std::optional<double> plane_nm;  ///< top of the substrate
  std::uint32_t plane_shell = 0;
  std::span<const std::uint32_t> shell_of;  ///< per triangle
  std::unique_ptr<EmbreeScene>
      triangles;  ///< null for a bare substrate; holds what is per triangle
  DistanceGrid near;
  HorizonMap sky;
  double top_nm = 0;        ///< highest surface
  double bottom_nm = 0;     ///< lowest surface
  bool half_space = false;  ///< whether something goes on below without end
  double farthest_nm = 0;   ///< longer than any path inside the solids

  double clearance_nm(const Vec3& p) const {
    double bound = triangles ? near.bound_nm(p) : std::numeric_limits<double>::infinity();
    if (plane_nm) bound = std::min(bound, std::fabs(p.z - *plane_nm));
    return bound;
  }

  /// True only where the ray from a point in vacuum meets nothing; cheap.
  bool flies_free(const Vec3& p, const Vec3& direction) const {
    if (plane_nm && !(p.z >= *plane_nm && direction.z > 0)) return false;
    return triangles ? sky.is_free(p, direction) : plane_nm.has_value();
  }
};

/// Follows which shells a path is inside of. Holds scratch space: one per thread.
class SceneGeometry {
 public:
  using State = int;  ///< index into `states_`; 0 is vacuum
  struct Surface {
    double distance = 0;
    Vec3 position;        ///< on the near side
    Vec3 position_ahead;  ///< on the far side: behind all faces that coincide
    Vec3 normal;
    State state_ahead = 0;
  };

  explicit SceneGeometry(const Scene::Impl& scene);

  int material(State s) const { return states_[static_cast<std::size_t>(s)].material; }
  double clearance(const Vec3& p) const { return scene_.clearance_nm(p); }
  double farthest() const { return scene_.farthest_nm; }
  bool flies_free(const Vec3& p, const Vec3& direction) const {
    return scene_.flies_free(p, direction);
  }

  /// The first surface between different materials within `length`.
  Crossing crossing(const Vec3& start, const Vec3& direction, double length, State& state,
                    Surface& surface, const KnownFaces& faces = {});

 private:
  struct Nesting {
    std::vector<std::uint32_t> inside;  // shells, sorted
    int material = -1;
    std::vector<std::pair<std::uint32_t, State>> next;
  };
  struct Face {
    double distance = 0;
    Vec3 position;
    Vec3 normal;
    std::uint32_t shell = 0;
  };

  bool is_inside(State s, std::uint32_t shell) const;
  bool goes_in(std::uint32_t shell, double cosine) const {
    return (cosine < 0) == (scene_.shells[shell].sense > 0);
  }
  State across(State s, std::uint32_t shell);
  State intern(std::vector<std::uint32_t> inside);
  Crossing next_face(const Vec3& start, const Vec3& direction, double length, State state,
                     const KnownFaces& faces, Face& face);
  static bool accept(void* self, std::uint32_t triangle, double cosine, double distance);

  const Scene::Impl& scene_;
  const bool faces_may_coincide_;
  std::vector<Nesting> states_;
  State asking_ = 0;  // for `accept`
  double wrong_side_at_ = 0;
};

}  // namespace surf::mc
