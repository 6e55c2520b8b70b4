// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/afm/clean.h"
#include "surf/core/height_field.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

/// Replaces a height by the median around it if it differs from the median by more than a limit.
struct Spikes {
  int width = 3;                   ///< width of the neighbourhood in samples, odd
  std::optional<double> limit_nm;  ///< absent: six standard deviations of the single-pixel noise
};

/// The steps asked for are done in this order: spikes, median, closing. Widths are odd.
struct CleanParameters {
  std::optional<Spikes> spikes;
  std::optional<int> median, closing;  ///< widths
  bool disc = false;                   ///< medians are taken over discs instead of squares
  bool fill_holes = false;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// The parameters clean.spikes, clean.median, clean.closing, clean.disc and clean.fill_holes.
void describe(ParameterVisitor& visit, CleanParameters& parameters);

/// Throws UsageError for values out of range and even widths.
void check(const CleanParameters& parameters);

struct CleanResult {
  HeightField field;
  std::optional<CleanSummary> spikes, median, closing;
  CleanParameters used;  ///< the parameters, with the estimated spike limit filled in
};

/// Throws InvalidInput, UsageError, Interrupted.
CleanResult clean(const HeightField& scan, const CleanParameters& parameters,
                  const Reporter& reporter = {});

}  // namespace surf::workflow
