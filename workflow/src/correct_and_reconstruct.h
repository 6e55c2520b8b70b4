// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "model_correction.h"
#include "reconstruction_checkpoint.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// Reconstructs, then lets Monte Carlo images of the surface correct the model and goes on with the
/// last scale, in at most `rounds` rounds: fewer if one moves nothing. `sem` and `views` get their
/// corrected models, and the errors of corrections in their discrepancies. Only the last
/// reconstruction computes the uncertainty. `summary` has the models. `checkpoint` may be null.
Reconstruction correct_and_reconstruct(
    const AfmData* afm, SemData& sem, std::vector<SemView>& views,
    const ReconstructionOptions& options, const ReconstructSummary& summary,
    const CorrectionRequest& request, int rounds, ReconstructionCheckpoint* checkpoint,
    const Reporter& reporter, std::vector<CorrectionRound>& done);

}  // namespace surf::workflow
