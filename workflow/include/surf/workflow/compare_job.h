// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "surf/compare/align_surfaces.h"
#include "surf/compare/find_changes.h"
#include "surf/core/height_field.h"
#include "surf/core/parameters.h"
#include "surf/mesh/triangle_mesh.h"
#include "surf/workflow/register_job.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/stored_model.h"

namespace surf::workflow {

/// A surface that was measured.
struct MeasuredSurface {
  HeightField field;
  /// Standard deviations of heights, of the field's size; empty: not known.
  Grid<double> deviation_nm;
};

/// A measured surface, or the mesh of an expected one.
using ComparedSurface = std::variant<MeasuredSurface, TriangleMesh>;

struct CompareParameters {
  bool registered = false;  ///< the places that both inputs state agree already
  std::optional<double> largest_shift_nm;
  double least_overlap = AlignOptions{}.least_overlap;
  /// Standard deviation of the heights' errors. Absent: as the file says; where it says nothing,
  /// from the difference.
  std::optional<double> before_deviation_nm, after_deviation_nm;
  double false_alarms = ChangeOptions{}.false_alarms;
  std::optional<double> largest_nm;
  int smallest_px = ChangeOptions{}.smallest_px;
  int simulations = ChangeOptions{}.simulations;
  double model_error = 0.05;  ///< of predicted SEM images, as a share of their contrast
  std::uint64_t seed = ChangeOptions{}.seed;
};
void describe(ParameterVisitor& visit, CompareParameters& parameters);

/// Compares a specimen at two times, or a specimen with what it should be.
struct CompareJob {
  std::filesystem::path before_file, after_file;
  ComparedSurface before;
  std::variant<MeasuredSurface, TriangleMesh, PlacedImage> after;  ///< PlacedImage: an SEM image
  ModelRequest model;                                              ///< for an SEM image
  CompareParameters parameters;
  int threads = 0;               ///< 0: one per hardware thread. Does not change the result
  std::filesystem::path folder;  ///< for results, created if missing; empty: none are written
  bool picture = true;
  std::string command_line;  ///< for the record

  bool of_image() const { return std::holds_alternative<PlacedImage>(after); }
};
/// All parameters but the files and the material.
void describe(ParameterVisitor& visit, CompareJob& job);

enum class CompareVerdict {
  unchanged,      ///< nothing differs beyond the errors
  changed,        ///< places do
  not_registered  ///< the inputs could not be laid on each other: nothing was compared
};

struct CompareSummary {
  CompareVerdict verdict = CompareVerdict::not_registered;
  std::vector<std::string> reasons;   ///< why the result is not to be trusted; none: it is
  std::vector<std::string> warnings;  ///< also told to the reporter
  SurfaceAlignment alignment;         ///< of two surfaces
  std::optional<Pose> pose;           ///< of an SEM image
  double gain = 0, offset = 0;        ///< of an SEM image: image = gain prediction + offset
  double contrast = 0;                ///< of the predicted image, gain included; grey levels
  std::string unit;                   ///< of the difference: "nm", or "%" of an image's contrast
  /// On the samples of `difference`: what was before, and what is after, moved and levelled. Of an
  /// SEM image: the prediction with gain and offset, and the image.
  PlacedImage before, after;
  MeasuredDifference difference;
  std::string deviation_from;  ///< where the deviations come from, for people
  Changes changes;
  std::vector<std::filesystem::path> written;
};

/// Lays `after` on `before`, finds where they differ beyond their errors, and writes change.vti,
/// places.csv, report.json and panel.png to the folder. Inputs that cannot be laid on each other
/// get a report with the verdict alone. Throws UsageError, InvalidInput, FileError, Interrupted.
CompareSummary run(const CompareJob& job, const Reporter& reporter = {});

/// Reads a surface of any kind: a mesh by its content, else a scan. A scan with a channel
/// "deviation_nm", such as surface.vti of a reconstruction, brings its deviations. `notes`: what
/// had to be assumed.
ComparedSurface read_compared_surface(const std::filesystem::path& file,
                                      const io::HeightReadOptions& reading,
                                      const io::MeshUnit& unit, std::vector<std::string>& notes);

/// "unchanged", "changed" or "not registered".
const char* name(CompareVerdict verdict);

}  // namespace surf::workflow
