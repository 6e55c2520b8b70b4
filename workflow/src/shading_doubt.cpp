// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading_doubt.h"

#include <cmath>

namespace surf::workflow {

Measured doubted(const Measured& fitted, const NumberPrior& prior, double doubt) {
  if (!(prior.deviation > 0) || !(fitted.standard_error > 0)) return fitted;
  const double known = 1 / (prior.deviation * prior.deviation),
               both = 1 / (fitted.standard_error * fitted.standard_error),
               told = both - known;  // by the data
  if (!(told > 0)) return fitted;
  const double by_data = (fitted.value * both - prior.mean * known) / told,
               less = 1 / (1 / told + doubt * doubt);
  return {(prior.mean * known + by_data * less) / (known + less), 1 / std::sqrt(known + less)};
}

}  // namespace surf::workflow
