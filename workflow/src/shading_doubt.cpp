// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading_doubt.h"

#include <cmath>

namespace surf::workflow {

double doubted_error(double fitted, double prior_deviation, double doubt) {
  if (!(prior_deviation > 0) || !(fitted > 0)) return fitted;
  const double known = 1 / (prior_deviation * prior_deviation),
               told = 1 / (fitted * fitted) - known;  // by the data
  if (!(told > 0)) return fitted;
  return 1 / std::sqrt(known + 1 / (1 / told + doubt * doubt));
}

}  // namespace surf::workflow
