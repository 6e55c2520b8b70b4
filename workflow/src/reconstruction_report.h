// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// The report as JSON: inputs, all parameters, given or estimated, verdict, residuals, scales, and
/// the command that makes the same surface again. It does not depend on the clock, on threads or on
/// the machine.
std::string reconstruction_report(const ReconstructJob& job, const ReconstructSummary& summary,
                                  const AfmData* afm, const SemData* sem);

/// The name of the file of a view's model: the first image's, if it is the same.
std::string view_model_name(const ReconstructSummary& summary, std::size_t view);

/// The job without its images: the part that has parameters.
ReconstructJob parameters_of(const ReconstructJob& job);

/// The job without its images, with estimated values in place of their estimation: a job that makes
/// the same surface from the same images, tip and model. Files record it, so that a repeated run
/// writes the same files.
ReconstructJob parameters_used(const ReconstructJob& job, const ReconstructSummary& summary,
                               const AfmData* afm, const SemData* sem);

/// The words of the command that makes the same surface again, with all estimated values given.
std::vector<std::string> repeating_command(const ReconstructJob& job,
                                           const ReconstructSummary& summary, const AfmData* afm,
                                           const SemData* sem);

}  // namespace surf::workflow
