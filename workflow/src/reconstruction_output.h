// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// Writes all files of a result; the report comes last, so that where there is one the rest is
/// whole. Returns their names. `afm` and `sem` are what the reconstruction was given, or null.
std::vector<std::filesystem::path> write_reconstruction(const ReconstructJob& job,
                                                        const ReconstructSummary& summary,
                                                        const AfmData* afm, const SemData* sem);

/// The scales as a table: sigma_px, curvature_prior_per_nm, afm, sem, prior, gradient_norm,
/// iterations, evaluations, products, ended, and of each image's whitened residuals mean,
/// deviation, along, across, like_noise.
std::string history_text(const std::vector<ScaleReport>& scales);

}  // namespace surf::workflow
