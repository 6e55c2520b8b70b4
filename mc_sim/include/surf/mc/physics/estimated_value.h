// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace surf::mc {

/// A value that was not given but follows from a rule.
struct EstimatedValue {
  std::string field;  ///< of Material, "plasmon_ev"
  std::string rule;   ///< in words; completes "estimated: "
};

}  // namespace surf::mc
