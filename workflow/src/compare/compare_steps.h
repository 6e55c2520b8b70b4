// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "surf/io/plot.h"
#include "surf/workflow/compare_job.h"

namespace surf::workflow {

// The parts of a comparison. Each fills in its part of the summary; the first two return false if
// the inputs could not be laid on each other.

/// Alignment and difference of two surfaces, and the smallest spread that is believed.
bool difference_of_surfaces(const CompareJob& job, const Reporter& reporter,
                            CompareSummary& summary, double& least_spread);

/// Registration of an SEM image, and its difference from the image that the surface predicts.
bool difference_from_image(const CompareJob& job, const Reporter& reporter,
                           CompareSummary& summary);

/// Tells the reporter and the summary.
void warn(const std::string& text, const Reporter& reporter, CompareSummary& summary);

/// Pictures of both, of the difference and of the probability, with outlined places.
io::Plot compare_picture(const CompareJob& job, const CompareSummary& summary);

/// Writes what a comparison found into its folder; returns the files.
std::vector<std::filesystem::path> write_comparison(const CompareJob& job,
                                                    const CompareSummary& summary);

}  // namespace surf::workflow
