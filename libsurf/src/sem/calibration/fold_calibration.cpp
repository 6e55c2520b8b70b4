// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/sem/fit_filter_bank.h"

namespace surf {

FilterBankParameters fold_calibration(const FilterBankParameters& parameters,
                                      const std::vector<double>& gains, double offset) {
  if (gains.size() != parameters.channels.size())
    throw InvalidInput(
        "calibration",
        fmt::format("it has {} gains for {} channels", gains.size(), parameters.channels.size()),
        "Give one for each channel");
  FilterBankParameters folded{parameters.scales, parameters.multi_resolution, {}};
  const std::vector<double> none(parameters.scales.size());
  FilterBankChannel& signal =
      folded.channels.emplace_back(FilterBankChannel{"signal", offset, none, none, none});
  for (std::size_t c = 0; c < gains.size(); ++c) {
    if (!std::isfinite(gains[c]))
      throw InvalidInput("calibration", fmt::format("a gain is {}", gains[c]),
                         "Gains must be finite");
    const FilterBankChannel& channel = parameters.channels[c];
    signal.offset += gains[c] * channel.offset;
    for (std::size_t i = 0; i < none.size(); ++i) {
      signal.slope[i] += gains[c] * channel.slope.at(i);
      signal.max_curvature[i] += gains[c] * channel.max_curvature.at(i);
      signal.min_curvature[i] += gains[c] * channel.min_curvature.at(i);
    }
  }
  make_filter_bank({}, folded);  // throws if something is out of range
  return folded;
}

}  // namespace surf
