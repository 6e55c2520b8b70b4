// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// The reconstruction less the true heights, which are interpolated at its samples. Throws
/// InvalidInput where the two have fewer than 16 places in common.
TruthReport compare_with_truth(const Reconstruction& result, const HeightField& truth);

/// The true heights on the samples of a surface, of the same frame; not valid beyond them.
HeightField truth_on(const HeightField& surface, const HeightField& truth);

/// Root mean square of what they differ by at places of the surface that both know, the mean
/// difference taken off.
double rms_off(const HeightField& surface, const HeightField& truth);

}  // namespace surf::workflow
