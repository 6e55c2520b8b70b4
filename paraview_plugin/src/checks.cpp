// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf::pv {

void need_number(double value, const char* label) {
  if (!std::isfinite(value))
    throw UsageError(label, fmt::format("it is {}, no number", value), "Give a finite one");
}

void need_between(double value, double low, double high, const char* label) {
  need_number(value, label);
  if (value < low || value > high)
    throw UsageError(label, fmt::format("{} is not in {} to {}", value, low, high),
                     "Give one in between");
}

void need_moderate(double value, const char* label) { need_between(value, -1e9, 1e9, label); }

void need_length(double nm, const char* label) {
  need_number(nm, label);
  constexpr double most_nm = 1e9;
  if (nm > most_nm)
    throw UsageError(label, fmt::format("{} nm are more than {}, a metre", nm, most_nm),
                     "Give a length in nm");
  if (nm < 0) throw UsageError(label, fmt::format("{} nm are below 0", nm), "Give a length, or 0");
}

void need_positive(double nm, const char* label) {
  need_length(nm, label);
  if (nm == 0) throw UsageError(label, "0 nm are not above 0", "Give a length");
}

void need_within(int value, int low, int high, const char* label) {
  if (value < low || value > high)
    throw UsageError(label, fmt::format("{} is not in {} to {}", value, low, high),
                     "Choose among these");
}

}  // namespace surf::pv
