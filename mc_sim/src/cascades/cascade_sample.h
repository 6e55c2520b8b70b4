// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/cascades/cascade_library.h"

namespace surf::mc {

/// What the cascades of a library take on average, from its first few.
struct CascadeSample {
  double bytes = 0;
  double segments = 0;
};

/// Makes cascades up to a megabyte, four at least: a tenth of a second, up to some seconds for the
/// largest at 30 keV. The same for the same settings.
CascadeSample sample_cascades(const CascadeSettings& settings);

}  // namespace surf::mc
