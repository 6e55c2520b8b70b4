// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "surf/io/plot.h"
#include "surf/workflow/count_job.h"

namespace surf::workflow {

/// One set of counts with its fits. Where all counts are equal only the Poisson fit is there.
struct FittedCounts {
  DetectorCounts set;
  CountMoments moments;
  PoissonCounts poisson;
  bool spread = false;  ///< the others are fitted
  LogNormalCounts log_normal;
  NormalCounts normal;
};
FittedCounts fit_counts(const DetectorCounts& set);

/// A panel for each set, `detectors` beside each other (thesis, figures 8-5 to 8-7).
io::Plot plot_counts(const std::vector<FittedCounts>& sets, int detectors);

/// detector, primaries, count, trials, poisson, log_normal, normal: of each count the trials seen
/// and expected. Before them lines "# key = value" of `made`.
std::string counts_csv(const std::vector<FittedCounts>& sets,
                       const std::map<std::string, std::string>& made);

}  // namespace surf::workflow
