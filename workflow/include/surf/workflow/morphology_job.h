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
/// "erode" and so on.
const char* name(MorphologyOperation operation);

struct MorphologyParameters {
  int upsample = MorphologyOptions{}.upsample;
  double distance_nm =
      0;            ///< kept from the surface, of non-contact scans; opening and closing know none
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// morphology.upsample and morphology.distance.
void describe(ParameterVisitor& visit, MorphologyParameters& parameters);

/// Throws InvalidInput, UsageError, Interrupted.
HeightField morphology(MorphologyOperation operation, const HeightField& field, const Tip& tip,
                       const MorphologyParameters& parameters, const Reporter& reporter = {});

/// The tip as it meets a scan: of its pitch, with a note where it was resampled, a warning where it
/// is larger, and one where `name`, the tip's file, says that it is not to be trusted. Throws
/// InvalidInput.
Tip tip_for(Tip tip, const HeightField& scan, const std::string& name,
            const Reporter& reporter = {});

}  // namespace surf::workflow
