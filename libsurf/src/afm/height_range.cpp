// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/height_range.h"

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"

namespace surf {

HeightRange height_range(std::span<const HeightField> fields) {
  HeightRange range{HUGE_VAL, -HUGE_VAL};
  for (const HeightField& f : fields)
    for (int y = 0; y < f.z_nm.height(); ++y)
      for (int x = 0; x < f.z_nm.width(); ++x)
        if (f.is_valid(x, y)) {
          range.low_nm = std::min(range.low_nm, f.z_nm(x, y));
          range.high_nm = std::max(range.high_nm, f.z_nm(x, y));
        }
  if (range.low_nm > range.high_nm)
    throw InvalidInput("scan", "it has no valid pixel", "Give another");
  return range;
}

}  // namespace surf
