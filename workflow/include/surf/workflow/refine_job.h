// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/io/mesh_unit.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/mesh/triangle_mesh.h"
#include "surf/refinement/fit_modes.h"
#include "surf/workflow/register_job.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

/// Moves the vertices of a mesh until Monte Carlo images of it agree with SEM images from several
/// sides, undercuts included.
struct RefineJob {
  TriangleMesh start;  ///< a closed body, or a sheet that goes on level beyond its rim
  std::filesystem::path start_file;
  std::optional<double> substrate_z_nm;  ///< the same material below this height; absent: none
  std::vector<SemInput> images;
  /// How each was taken, one for each image or one for all. None: tilts and azimuths are 0.
  std::vector<double> tilts_deg, azimuths_deg;
  std::vector<std::string> signals;  ///< what each shows, see `detectors_of`; none: SE
  double tilt_error_deg = 0.2;       ///< standard error of the tilts, which are fitted; 0: held
  mc::Material material;
  mc::Physics physics;
  double energy_ev = 1000, spot_nm = 0;
  double start_error_nm = 10;   ///< what the start may be off by as a whole
  double height_error_nm = 10;  ///< likewise its heights, which an AFM scan tells
  double bump_error_nm = 3;     ///< and in places, over `bump_length_nm`
  double bump_length_nm = 20;
  double edge_nm = 0;                  ///< of the mesh's triangles; 0: chosen by the pixels
  double spacing_nm = 0;               ///< of bumps; 0: chosen by the triangles
  double model_error = 0.06;           ///< what simulations may be off by, a share of the contrast
  std::int64_t electrons = 200;        ///< per pixel of the images that are compared
  std::int64_t effect_electrons = 40;  ///< per pixel, of what each change does to them
  int smooth_rounds = 3, bump_rounds = 2;
  std::uint64_t seed = 1;
  std::filesystem::path cache;
  int threads = 0;               ///< 0: one per hardware thread. Does not change the result
  std::filesystem::path folder;  ///< for results; empty: none are written
  bool picture = true;
};
/// All parameters but the start, the images' files and the material.
void describe(ParameterVisitor& visit, RefineJob& job);

/// An image, as it is taken and as the refined mesh looks.
struct RefinedImage {
  double tilt_deg = 0, azimuth_deg = 0;  ///< fitted
  RefinedViewState state;
  Grid<double> simulated;           ///< gain and offset applied, on the image's pixels
  Grid<double> residual;            ///< measured less simulated, in standard deviations
  Grid<double> sensitivity_per_nm;  ///< of the surface that each pixel sees, see `sensitivity`
  double unexplained_before = 0, unexplained = 0;  ///< rms of what is left over the contrast
};

struct RefineSummary {
  TriangleMesh before;  ///< the start, with the vertices of the result
  TriangleMesh mesh;
  std::vector<double> deviation_nm;     ///< of each vertex, along its normal
  std::vector<double> displacement_nm;  ///< from `before`, along the normal
  /// What each view alone tells of the surface at each vertex: one over the standard error of a
  /// bump there if all else were known, 1/nm; 0 where its beam does not reach.
  std::vector<std::vector<double>> sensitivity;
  std::vector<RefinedImage> images;
  std::vector<MeshMode> modes;     ///< of the last rounds
  std::vector<double> covariance;  ///< of their amplitudes
  std::size_t self_intersections = 0;
  std::int64_t primaries = 0;        ///< that were simulated
  std::vector<std::string> reasons;  ///< why the result is not to be trusted; none: it is
  std::vector<std::filesystem::path> written;
};

/// Reads a mesh, or heights as the sheet that they are. `notes`: what had to be assumed.
TriangleMesh read_refined_start(const std::filesystem::path& file, const io::MeshUnit& unit,
                                std::vector<std::string>& notes);

/// Smooth changes of the whole shape first (sizes, angles of walls), then bumps everywhere. Writes
/// surface.vtp, surface.stl, section.csv, view1.vti and so on, report.json and panel.png to the
/// folder. Throws UsageError, InvalidInput, FileError, Interrupted.
RefineSummary run(const RefineJob& job, const Reporter& reporter = {});

}  // namespace surf::workflow
