// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/afm/clean.h"
#include "surf/core/height_field.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

/// A median where a height is off it by more than a limit.
struct Spikes {
  int width = 3;                   ///< samples, odd
  std::optional<double> limit_nm;  ///< else six standard deviations of the noise of single pixels
};

/// What is asked for happens in this order: spikes, median, closing. Widths are odd.
struct CleanParameters {
  std::optional<Spikes> spikes;
  std::optional<int> median, closing;  ///< widths
  bool disc = false;                   ///< medians are of discs
  bool fill_holes = false;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// clean.spikes, clean.median, clean.closing, clean.disc and clean.fill_holes.
void describe(ParameterVisitor& visit, CleanParameters& parameters);

/// Throws UsageError: ranges, and widths that are odd.
void check(const CleanParameters& parameters);

struct CleanResult {
  HeightField field;
  std::optional<CleanSummary> spikes, median, closing;
  CleanParameters used;  ///< with the limit of spikes that was found
};

/// Throws InvalidInput, UsageError, Interrupted.
CleanResult clean(const HeightField& scan, const CleanParameters& parameters,
                  const Reporter& reporter = {});

}  // namespace surf::workflow
