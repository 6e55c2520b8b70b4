// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surf/afm/best_tip.h"
#include "surf/afm/characterizer.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/afm/tip_shapes.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/height_field.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

enum class TipAnswer {
  sweep,  ///< blind reconstruction at the threshold that the noise explains
  outer,  ///< nowhere sharper than the tip in 95 % of noise draws
  best,   ///< the most likely tip
  blind,  ///< blind reconstruction at a given threshold
};

/// How a tip is found from scans made with it.
struct TipParameters {
  int size = BlindTipOptions{}.width;  ///< samples across, odd
  std::optional<TipAnswer> answer;     ///< Absent: blind with a threshold or `maxima`, else sweep
  std::optional<AfmNoise> noise;  ///< noise of the scans; absent: estimated if the answer needs it
  /// From here to `maxima`: for blind alone, as in BlindTipOptions.
  std::optional<double> threshold_nm;
  std::optional<double> threshold_y_nm;
  double apex_tolerance_nm = BlindTipOptions{}.apex_tolerance_nm;
  double layer_nm = BlindTipOptions{}.layer_nm;
  bool maxima = BlindTipOptions{}.maxima_only;
  /// For sweep alone.
  double sweep_least_nm = TipSweepOptions{}.least_nm, sweep_most_nm = TipSweepOptions{}.most_nm;
  int sweep_thresholds = TipSweepOptions{}.thresholds;
  std::uint64_t seed = TipSweepOptions{}.seed;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// The parameters tip.size, tip.answer, scan.height_noise, tip.threshold and so on, tip.sweep as
/// FROM,TO,N, and tip.seed.
void describe(ParameterVisitor& visit, TipParameters& parameters);

/// Throws UsageError for values out of range, an even size, and parameters that the answer does not
/// take.
void check(const TipParameters& parameters);

/// The parameter scan.height_noise: a standard deviation, or also the correlation of neighbours.
void describe_noise(ParameterVisitor& visit, std::optional<AfmNoise>& noise);

struct TipResult {
  Tip tip;             ///< with its doubt, if there is one
  TipParameters used;  ///< the parameters, with the answer, noise and threshold that were found
  bool noise_found = false;       ///< the noise was estimated
  double sigma_nm = 0;            ///< standard deviation of the noise; 0: not used
  std::optional<TipSweep> sweep;  ///< details of the search, depending on the answer
  std::optional<BestTipSummary> best;
  std::optional<BlindTipSummary> blind;
};

/// Finds the tip. The scans are made by one tip, levelled, and have one pitch. Throws InvalidInput,
/// UsageError, Interrupted.
TipResult find_tip(const std::vector<HeightField>& scans, const TipParameters& parameters,
                   const Reporter& reporter = {});

struct CharacterizerParameters {
  int size = BlindTipOptions{}.width;  ///< samples across, odd
  int search = CharacterizerOptions{}.search;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// The parameters tip.size and tip.search.
void describe(ParameterVisitor& visit, CharacterizerParameters& parameters);

/// Finds the tip from the scan of a known surface. Throws InvalidInput, UsageError.
CharacterizedTip tip_by_characterizer(const HeightField& scan, const HeightField& characterizer,
                                      const CharacterizerParameters& parameters,
                                      const Reporter& reporter = {});

/// The shape of a tip, written as "parabola:RADIUS", "cone:RADIUS,ANGLE",
/// "pyramid:RADIUS,ANGLE,FACES[,ROTATION]", "ball:RADIUS" or "ball:RADIUS,STEM_RADIUS,STEM_ANGLE".
struct TipShape {
  enum Kind { cone, parabola, pyramid, ball };
  Kind kind = cone;
  double radius_nm = 10;
  double half_angle_deg = 15;  ///< for a cone and for a pyramid's faces, from the axis
  int faces = 4;               ///< number of faces of a pyramid
  double rotation_deg = 0;     ///< for a pyramid's first face, from +x
  double stem_radius_nm = 0;   ///< for a ball; 0: the stem is a cylinder that is never seen
  double stem_half_angle_deg = 0;
};
/// The parameters tip.kind, tip.radius and so on, each by itself: for front ends that ask for
/// numbers instead of a text.
void describe(ParameterVisitor& visit, TipShape& shape);
/// Parses such a text. Throws UsageError naming `subject`.
TipShape parse_tip_shape(std::string_view text, const std::string& subject);
std::string format_tip_shape(const TipShape& shape);

struct TipShapeParameters {
  TipShape shape;
  int size = TipSampling{}.width;  ///< samples across, odd
  /// Pitch of the scans that the tip is for.
  double pitch_x_nm = TipSampling{}.pitch_x_nm, pitch_y_nm = TipSampling{}.pitch_y_nm;
};
/// The parameters tip.shape and tip.size.
void describe(ParameterVisitor& visit, TipShapeParameters& parameters);

/// Samples the shape. Throws UsageError naming `subject` for shapes that are not possible.
Tip tip_by_shape(const TipShapeParameters& parameters, const std::string& subject = "`tip.shape`");

/// Warns about noise that was estimated from one of the scans it is for: structure may have been
/// taken for noise.
void tell_noise_doubts(const AfmNoise& noise, bool alpha_at_limit, const HeightField& scan,
                       const Reporter& reporter);
/// Warns about a tip that was found with a doubt.
void tell_tip_doubt(const Tip& tip, const Reporter& reporter);

}  // namespace surf::workflow
