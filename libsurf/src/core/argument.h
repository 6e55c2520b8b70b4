// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {

/// Throws UsageError unless `value` is finite and above 0.
inline void require_positive(double value, const std::string& subject) {
  if (std::isfinite(value) && value > 0) return;
  throw UsageError(subject, "it is " + format_exact(value), "Give a finite number above 0");
}

/// Throws UsageError unless `value` is finite and not below 0.
inline void require_not_negative(double value, const std::string& subject) {
  if (std::isfinite(value) && value >= 0) return;
  throw UsageError(subject, "it is " + format_exact(value), "Give a finite number, 0 or above");
}

/// Throws UsageError unless `value` is finite.
inline void require_finite(double value, const std::string& subject) {
  if (std::isfinite(value)) return;
  throw UsageError(subject, "it is " + format_exact(value), "Give a finite number");
}

}  // namespace surf
