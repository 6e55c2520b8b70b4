// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/transform.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::pv {

Affine to_affine(const double v[6]) {
  constexpr double most = 1e9;  // nm: what lies farther away is no image's
  for (int i = 0; i < 6; ++i)
    if (!(std::abs(v[i]) <= most))
      throw UsageError("Transform", fmt::format("{} is no number within +-{}", v[i], most),
                       "Give 1 0 0 0 1 0 for none");
  const Affine map{v[0], v[1], v[2], v[3], v[4], v[5]};
  try {
    inverse(map);
  } catch (const InvalidInput& error) {
    throw UsageError("Transform", error.reason(), "Give 1 0 0 0 1 0 for none");
  }
  return map;
}

std::string text_of(const Affine& m) {
  std::string text;
  for (const double value : {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0})
    text += fmt::format("{}{}", text.empty() ? "" : " ", format_exact(value));
  return text;
}

}  // namespace surf::pv
