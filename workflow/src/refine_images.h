// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "profile_signals.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/request/simulation_options.h"
#include "surf/workflow/refine_job.h"

namespace surf::workflow {

/// A mesh's simulated image.
struct RefineImage {
  Grid<double> mean, variance;  ///< of yields
};

/// Simulates the images of a job's meshes, from the sides that views have.
class RefineImages {
 public:
  RefineImages(const RefineJob& job, mc::LibrarySource& libraries);

  double tilt_deg(std::size_t view, const RefinedViewState& state) const;
  double azimuth_deg(std::size_t view, const RefinedViewState& state) const;

  RefineImage render(const TriangleMesh& mesh, std::size_t view, const RefinedViewState& state,
                     std::int64_t electrons, std::uint64_t seed, int threads, const Watch& watch,
                     const Grid<std::int64_t>* pixels = nullptr) const;

  /// What the middles of pixels see of the mesh; NaN where they see nothing.
  Grid<Vec3> seen(const TriangleMesh& mesh, std::size_t view, const RefinedViewState& state) const;

  /// What modes change in a view, by two simulations, each of a step to either side, `electrons`
  /// per pixel on average in all these images together, with seeds from `seed` to `seed` + 3; and
  /// tilts of the beam, where they are fitted. `counted` adds up primaries of the modes.
  void add_effects(const TriangleMesh& base, const std::vector<MeshMode>& modes,
                   const std::vector<double>& amplitudes_nm,
                   const std::vector<RefinedViewState>& states, std::int64_t electrons,
                   std::uint64_t seed, const Watch& watch, std::vector<RefinedView>& views,
                   std::int64_t& counted) const;

 private:
  mc::Beam beam(std::size_t view, const RefinedViewState& state) const;
  mc::Scan scan(std::size_t view, const RefinedViewState& state) const;
  mc::Specimen specimen(const TriangleMesh& mesh) const;

  const RefineJob& job_;
  mc::LibrarySource& libraries_;
  mc::Method method_;
  double margin_nm_;  // how far beside a bump its effects reach
};

/// Vertices of the triangles that pixels see, and of those next to these.
std::vector<bool> vertices_in_sight(const TriangleMesh& mesh, const Grid<Vec3>& seen);

/// What a list says of each image: one value for each, or one for all.
template <class T>
T of_view(const std::vector<T>& list, std::size_t view, const T& otherwise) {
  return list.empty() ? otherwise : list.size() == 1 ? list.front() : list[view];
}

}  // namespace surf::workflow
