// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// The report as JSON: inputs, every parameter, given or estimated, verdict, residuals, scales, and
/// the command that makes the same surface again. Nothing of the clock, of threads or of the
/// machine.
std::string reconstruction_report(const ReconstructJob& job, const ReconstructSummary& summary,
                                  const AfmData* afm, const SemData* sem);

/// The job without its images: what there is to describe.
ReconstructJob parameters_of(const ReconstructJob& job);

/// The same with what was found in place of how it is found: a job that makes the same surface from
/// the same images, tip and model. Files say this of themselves, so a run that is repeated gives
/// the same ones.
ReconstructJob parameters_used(const ReconstructJob& job, const ReconstructSummary& summary,
                               const AfmData* afm, const SemData* sem);

/// The words of the command that makes the same surface again, with all that was estimated given.
std::vector<std::string> repeating_command(const ReconstructJob& job,
                                           const ReconstructSummary& summary, const AfmData* afm,
                                           const SemData* sem);

}  // namespace surf::workflow
