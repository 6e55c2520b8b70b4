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
  sweep,  ///< the threshold is the one that the noise explains
  outer,  ///< nowhere sharper than the tip in 95 % of noise draws
  best,   ///< the most likely tip
  blind,  ///< at a given threshold
};

/// How a tip is found in scans made with it.
struct TipParameters {
  int size = BlindTipOptions{}.width;  ///< samples across, odd
  std::optional<TipAnswer>
      answer;  ///< else blind where there is a threshold or `maxima`, sweep where not
  std::optional<AfmNoise> noise;  ///< of the scans; else estimated, where the answer needs it
  std::optional<double>
      threshold_nm;  ///< this to `maxima`: of blind alone, as BlindTipOptions has them
  std::optional<double> threshold_y_nm;
  double apex_tolerance_nm = BlindTipOptions{}.apex_tolerance_nm;
  double layer_nm = BlindTipOptions{}.layer_nm;
  bool maxima = BlindTipOptions{}.maxima_only;
  double sweep_least_nm = TipSweepOptions{}.least_nm,
         sweep_most_nm = TipSweepOptions{}.most_nm;  ///< of sweep alone
  int sweep_thresholds = TipSweepOptions{}.thresholds;
  std::uint64_t seed = TipSweepOptions{}.seed;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// tip.size, tip.answer, scan.height_noise, tip.threshold and so on, tip.sweep as FROM,TO,N, and
/// tip.seed.
void describe(ParameterVisitor& visit, TipParameters& parameters);

/// Throws UsageError: ranges, a size that is odd, what its answer does not take.
void check(const TipParameters& parameters);

/// scan.height_noise as a standard deviation, or with the correlation of neighbours.
void describe_noise(ParameterVisitor& visit, std::optional<AfmNoise>& noise);

struct TipResult {
  Tip tip;                        ///< with the doubt that there is
  TipParameters used;             ///< with the answer, the noise and the threshold that were found
  bool noise_found = false;       ///< it was estimated
  double sigma_nm = 0;            ///< of the noise; 0: it played no part
  std::optional<TipSweep> sweep;  ///< how it was found
  std::optional<BestTipSummary> best;
  std::optional<BlindTipSummary> blind;
};

/// Scans by one tip, levelled, of one pitch. Throws InvalidInput, UsageError, Interrupted.
TipResult find_tip(const std::vector<HeightField>& scans, const TipParameters& parameters,
                   const Reporter& reporter = {});

struct CharacterizerParameters {
  int size = BlindTipOptions{}.width;  ///< samples across, odd
  int search = CharacterizerOptions{}.search;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// tip.size and tip.search.
void describe(ParameterVisitor& visit, CharacterizerParameters& parameters);

/// The tip from the scan of a surface that is known. Throws InvalidInput, UsageError.
CharacterizedTip tip_by_characterizer(const HeightField& scan, const HeightField& characterizer,
                                      const CharacterizerParameters& parameters,
                                      const Reporter& reporter = {});

/// A tip by its shape, as texts say it: "parabola:RADIUS", "cone:RADIUS,ANGLE",
/// "pyramid:RADIUS,ANGLE,FACES[,ROTATION]", "ball:RADIUS" or "ball:RADIUS,STEM_RADIUS,STEM_ANGLE".
struct TipShape {
  enum Kind { cone, parabola, pyramid, ball };
  Kind kind = cone;
  double radius_nm = 10;
  double half_angle_deg = 15;  ///< of a cone and of a pyramid's faces, from the axis
  int faces = 4;               ///< of a pyramid
  double rotation_deg = 0;     ///< of a pyramid's first face, from +x
  double stem_radius_nm = 0;   ///< of a ball; 0: on a cylinder, which is never seen
  double stem_half_angle_deg = 0;
};
/// tip.kind, tip.radius and so on, each by itself: for who asks for numbers, not for a text.
void describe(ParameterVisitor& visit, TipShape& shape);
/// Throws UsageError naming `subject`.
TipShape parse_tip_shape(std::string_view text, const std::string& subject);
std::string format_tip_shape(const TipShape& shape);

struct TipShapeParameters {
  TipShape shape;
  int size = TipSampling{}.width;  ///< samples across, odd
  double pitch_x_nm = TipSampling{}.pitch_x_nm,
         pitch_y_nm = TipSampling{}.pitch_y_nm;  ///< of the scans that it meets
};
/// tip.shape and tip.size.
void describe(ParameterVisitor& visit, TipShapeParameters& parameters);

/// Throws UsageError naming `subject` for shapes that are not possible.
Tip tip_by_shape(const TipShapeParameters& parameters, const std::string& subject = "`tip.shape`");

/// Warnings of noise that was estimated from one of the scans it is of: structure may have been
/// taken for it.
void tell_noise_doubts(const AfmNoise& noise, bool alpha_at_limit, const HeightField& scan,
                       const Reporter& reporter);
/// The warning of a tip that was found, where it has a doubt.
void tell_tip_doubt(const Tip& tip, const Reporter& reporter);

}  // namespace surf::workflow
