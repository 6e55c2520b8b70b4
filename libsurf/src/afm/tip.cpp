// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip.h"

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf {

void validate(const Tip& tip, const char* subject) {
  const auto refuse = [&](const std::string& reason) {
    throw InvalidInput(subject, reason, "Give a tip whose highest sample, its apex, is 0");
  };
  const Grid<double>& z = tip.z_nm;
  if (z.empty()) refuse("it has no samples");
  if (tip.apex_x < 0 || tip.apex_x >= z.width() || tip.apex_y < 0 || tip.apex_y >= z.height())
    refuse(fmt::format("its apex ({}, {}) is outside its {} x {} samples", tip.apex_x, tip.apex_y,
                       z.width(), z.height()));
  if (z(tip.apex_x, tip.apex_y) != 0)
    refuse(fmt::format("its apex is at {:g} nm, not 0", z(tip.apex_x, tip.apex_y)));
  for (int y = 0; y < z.height(); ++y)
    for (int x = 0; x < z.width(); ++x)
      if (!(z(x, y) <= 0)) refuse(fmt::format("sample ({}, {}) is {:g} nm", x, y, z(x, y)));
  validate(tip.pitch(), subject);
}

Tip reflected(const Tip& tip) {
  Tip out = tip;
  const int w = tip.z_nm.width(), h = tip.z_nm.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) out.z_nm(x, y) = tip.z_nm(w - 1 - x, h - 1 - y);
  out.apex_x = w - 1 - tip.apex_x;
  out.apex_y = h - 1 - tip.apex_y;
  return out;
}

}  // namespace surf
