// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "surf/core/height_field.h"

namespace surf {

struct HeightRange {
  double low_nm = 0, high_nm = 0;
  double span_nm() const { return high_nm - low_nm; }
};

/// The range of all valid samples of all fields. Throws InvalidInput if there is no valid sample.
HeightRange height_range(std::span<const HeightField> fields);

}  // namespace surf
