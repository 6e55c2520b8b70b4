// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/afm/morphology.h"
#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

enum class MorphologyOperation { erode, dilate, open, close };
/// "erode", "dilate", "open" or "close".
const char* name(MorphologyOperation operation);

struct MorphologyParameters {
  int upsample = MorphologyOptions{}.upsample;
  /// Distance that the tip keeps from the surface in non-contact scans; not for opening and
  /// closing.
  double distance_nm = 0;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// The parameters morphology.upsample and morphology.distance.
void describe(ParameterVisitor& visit, MorphologyParameters& parameters);

/// Applies the operation. Throws InvalidInput, UsageError, Interrupted.
HeightField morphology(MorphologyOperation operation, const HeightField& field, const Tip& tip,
                       const MorphologyParameters& parameters, const Reporter& reporter = {});

/// Prepares a tip for a scan by resampling it to the scan's pitch. Notes the resampling. Warns if
/// the tip is larger than the scan, and if `name`, the tip's file, states a doubt. Throws
/// InvalidInput.
Tip tip_for(Tip tip, const HeightField& scan, const std::string& name,
            const Reporter& reporter = {});

}  // namespace surf::workflow
