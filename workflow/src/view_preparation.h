// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// More further SEM images than anybody has.
inline constexpr std::size_t most_views = 15;

/// What the first image shows.
std::string first_signal(const ReconstructJob& job);

/// Whether places, gains and noise are given, so that no surface is needed to find them.
bool all_known(const KnownViews& known);

/// Before any work. Throws UsageError.
void check_views(const ReconstructJob& job);

/// Finds a model for each further image, its place by the surface as far as that is known, and its
/// first gains, offset and noise. `sem` is the first image's data; `surface`: as the scan and it
/// say, or null without a scan. Summaries go to `s.views`.
std::vector<SemView> prepare_views(const ReconstructJob& job, ReconstructSummary& s,
                                   const SemData& sem, const HeightField* surface,
                                   const Reporter& reporter);

}  // namespace surf::workflow
