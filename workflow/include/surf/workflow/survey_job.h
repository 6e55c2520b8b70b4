// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/parameters.h"
#include "surf/workflow/level_job.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/tip_job.h"

namespace surf::workflow {

struct SurveyParameters {
  bool no_tip = false;  ///< leave out the tip, which takes nearly all of the time
  int draws = 5;        ///< of noise, for the error of the tip's radius, 2 to 1000
};
void describe(ParameterVisitor& visit, SurveyParameters& parameters);

/// What one scan says of itself, levelled first. Absent: not known, and `problem` says why.
struct SurveyedScan {
  std::filesystem::path file;
  int width = 0, height = 0;
  double pitch_x_nm = 0, pitch_y_nm = 0;
  double tilt_deg = 0;  ///< taken off
  /// Share of the samples on the plane that most of the scan lies on, in [0, 1]; 1 where no such
  /// plane was sought.
  double substrate_share = 1;
  double roughness_nm = 0;  ///< Sq of those samples, noise included
  double relief_nm = 0;     ///< between the 0.5th and 99.5th percentile of all samples
  std::optional<double> noise_nm;
  /// Of a blind tip at the threshold that the noise explains: an outer bound, as sharp as the
  /// scan's features. The error is the scatter over draws of noise like the scan's, added to it:
  /// how far the radius can be reproduced, not how much sharper the tip may be.
  std::optional<double> tip_radius_nm, tip_radius_error_nm, tip_half_angle_deg;
  /// What the tip adds to features on each side, at half of the relief: the area that scan and
  /// eroded scan differ by, over the mean length of their edges there.
  std::optional<double> broadening_nm;
  std::string problem;  ///< why the tip is not to be trusted or not known; empty: no known reason
};

/// Levels the scan and measures it. A scan without features has no tip; that is a problem, no
/// error. Throws InvalidInput, UsageError, Interrupted.
SurveyedScan survey_scan(const HeightField& scan, const SurveyParameters& parameters,
                         const LevelParameters& levelling = {}, const TipParameters& tip = {},
                         const Reporter& reporter = {});

/// One line per scan under a line of names, numbers with 6 digits, empty fields where nothing is
/// known.
std::string survey_csv(std::span<const SurveyedScan> scans);

/// The files, and of folders the scans in them, by name. Throws FileError for what is not there,
/// and for folders without scans.
std::vector<std::filesystem::path> scans_of(const std::vector<std::filesystem::path>& paths);

}  // namespace surf::workflow
