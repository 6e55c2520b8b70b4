// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// Writes all files of a result and returns their names. The report comes last: if it exists, the
/// other files are complete. `afm` and `sem` are the inputs of the reconstruction, or null.
std::vector<std::filesystem::path> write_reconstruction(const ReconstructJob& job,
                                                        const ReconstructSummary& summary,
                                                        const AfmData* afm, const SemData* sem,
                                                        const std::vector<SemView>& views);

/// The scales as a table: sigma_px, curvature_prior_per_nm, afm, sem, prior, gradient_norm,
/// iterations, evaluations, products, ended, and for the whitened residuals of each image mean,
/// deviation, along, across, like_noise.
std::string history_text(const std::vector<ScaleReport>& scales);

}  // namespace surf::workflow
