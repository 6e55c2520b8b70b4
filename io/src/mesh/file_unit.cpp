// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_unit.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::io {

void check_unit(double unit_nm, const std::string& file) {
  if (unit_nm > 0 && std::isfinite(unit_nm)) return;
  throw UsageError(file, fmt::format("{} nm cannot be the unit of a mesh", unit_nm),
                   "Give a positive length");
}

double file_unit_nm(const MeshUnit& given, std::optional<double> stated_nm,
                    const std::string& file) {
  if (!given.nm) return stated_nm.value_or(1);
  check_unit(*given.nm, file);
  constexpr double rounding = 1e-9;  // a magnification and its inverse are not exact
  const bool agrees = !stated_nm || std::abs(*given.nm - *stated_nm) <= rounding * *stated_nm;
  if (agrees || given.overrides_file) return *given.nm;
  throw UsageError(file,
                   fmt::format("the file says that its unit is {}, and {} is given as the unit",
                               format_length(*stated_nm), format_length(*given.nm)),
                   "Leave the unit out; or add `override_unit` (in a scene file override_unit = "
                   "true) if the file is "
                   "wrong");
}

}  // namespace surf::io
