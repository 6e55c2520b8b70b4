// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/affine.h"
#include "surf/core/parameters.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/profile/fit_profile.h"
#include "surf/workflow/register_job.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/view_settings.h"

namespace surf::workflow {

/// Measures lines, trenches, edges or a hole in an SEM image by simulated profiles (Davidson and
/// Vladar 1999, doi:10.1117/12.350841; Villarrubia et al. 2004, doi:10.1117/12.535912).
struct ProfileJob {
  SemInput sem;
  std::vector<SemInput> views;  ///< further images of such features, from other sides
  ViewSettings view_settings;
  std::optional<HeightField> scan;  ///< an AFM scan that shows how high walls are
  std::filesystem::path scan_file;
  FeatureKind kind = FeatureKind::line;
  bool along_x = false;  ///< lines run along x, not y
  /// Of the walls, and its standard error; 0: by the scan. Required without one, because no
  /// upright view shows it: with tilted views a guess and a wide error do.
  double height_nm = 0, height_error_nm = 0;
  std::optional<double> pitch_nm;  ///< 0: there is one; absent: as walls repeat in the image
  double angle_deg = 87, angle_range_deg = 7;    ///< what is simulated to begin with
  double top_radius_nm = 4, foot_radius_nm = 4;  ///< usual radii of corners, as far off as large
  bool walls_apart = false;                      ///< left and right walls have shapes of their own
  double threshold = 0.5;                        ///< of the threshold method, beside
  mc::Material material;
  mc::Physics physics;
  double energy_ev = 1000, spot_nm = 0;
  std::string signal = "SE";  ///< what the image shows: SE, BSE or a detector, see `detectors_of`
  /// Primaries per simulated place of shapes, which tell how signals differ, and of the middle one,
  /// which tells the level of all.
  std::int64_t electrons = 500, middle_electrons = 20'000;
  int rounds = 3;             ///< libraries that are simulated, each about the fit before
  double model_error = 0.08;  ///< see ProfileFitOptions
  std::uint64_t seed = 1;
  std::filesystem::path cache;   ///< where libraries of cascades are kept; empty: nowhere
  int threads = 0;               ///< 0: one per hardware thread. Does not change the result
  std::filesystem::path folder;  ///< for results, created if missing; empty: none are written
  bool picture = true;
  std::string command_line;  ///< for the record
};
/// All parameters but the image's file and the material.
void describe(ParameterVisitor& visit, ProfileJob& job);

struct ProfileSummary {
  ThresholdEdges threshold;                   ///< edges by the threshold method
  std::vector<Measured> threshold_widths_nm;  ///< of each feature; errors by the scatter of rows
  std::optional<Circle> hole;
  double pitch_nm = 0;                        ///< of the simulated features; 0: one
  std::optional<Measured> measured_pitch_nm;  ///< mean distance of features in the image
  std::optional<Measured> scan_height_nm;     ///< by the scan
  ProfileFit fit;
  HeightField surface;        ///< of that shape, with the edges of each row, on the image's pixels
  Grid<double> deviation_nm;  ///< standard deviation of its heights
  Grid<double> fitted;        ///< the image as the fitted mean profiles have it
  std::vector<std::vector<Point2>> edge_lines_nm;  ///< of each edge its places, in the image
  double row_distance_nm = 1;                      ///< between places of an edge, along it
  double discrepancy_share = 0;  ///< what the simulation is off by, over the contrast; the most
  std::int64_t simulated = 0;    ///< profiles
  /// Images (the first is 0) that look as if they were tilted to the other side, or as if a
  /// detector at the other side saw them.
  std::vector<std::size_t> other_side;
  std::vector<std::string> reasons;  ///< why the result is not to be trusted; none: it is
  std::vector<std::filesystem::path> written;
};

/// Finds the edges, simulates profiles of shapes around a first guess, fits shape and edges, and
/// does so again about what was found. Writes profile.json, edges.csv, profiles.csv, spectrum.csv,
/// surface.gsf, surface.vti and panel.png to the folder. Throws UsageError, InvalidInput,
/// FileError, Interrupted.
ProfileSummary run(const ProfileJob& job, const Reporter& reporter = {});

}  // namespace surf::workflow
