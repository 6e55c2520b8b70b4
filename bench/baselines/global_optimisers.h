// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace surf::bench {

/// Something to minimise in a box.
struct BoxProblem {
  /// The value; where `gradient` is not null, it is written there, too.
  std::function<double(const double* at, double* gradient)> value;
  std::vector<double> start, low, high;  ///< of one length; the start lies within
};

/// Optimisers of NLopt 2.7.
enum class GlobalOptimiser {
  crs2,      ///< controlled random search with local mutation (Kaelo and Ali 2006,
             ///< doi:10.1007/s10957-006-9101-0)
  isres,     ///< evolution strategy (Runarsson and Yao 2005, doi:10.1109/TSMCC.2004.841906)
  direct_l,  ///< dividing rectangles, locally biased (Gablonsky and Kelley 2001,
             ///< doi:10.1023/A:1017930332101); begins at the middle of the box
  esch,      ///< evolution with Cauchy mutations (da Silva Santos et al. 2010,
             ///< doi:10.1109/LPT.2010.2051222)
  mlsl,      ///< many starts of L-BFGS, the only one that asks for gradients (Kan and Timmer 1987,
             ///< doi:10.1007/BF02592071)
};
std::string name(GlobalOptimiser optimiser);

/// What was best when an optimiser had run for some time.
struct BestSoFar {
  double seconds = 0, value = 0;  ///< of a processor
  std::vector<double> at;
};

struct GlobalRun {
  /// A new entry where the value is lower and 5 % of the time later than at the entry before, and
  /// the last one.
  std::vector<BestSoFar> history;
  std::int64_t evaluations = 0;
};

/// Runs for so many seconds of a processor, or until the optimiser ends by itself. NLopt's random
/// numbers have one state for the process: one run at a time.
GlobalRun minimise(GlobalOptimiser optimiser, const BoxProblem& problem, double seconds,
                   std::uint64_t seed);

}  // namespace surf::bench
