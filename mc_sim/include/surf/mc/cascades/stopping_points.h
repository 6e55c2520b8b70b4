// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/cascades/cascade_library.h"
#include "surf/sem/stopping_point.h"

namespace surf::mc {

struct CascadeTableOptions {
  int rings = 48;      ///< about the beam, as far as anything is found, 1 to 1024
  int heights = 96;    ///< steps from the lowest to the highest of it, 2 to 1024
  /// Of stopping points alone, where above 0: SE is scaled so that level ground gives this yield. Without it
  /// the channel counts all secondaries that stop above, those included that start there: ten to a hundred
  /// times what leaves a surface.
  double flat_se_yield = 0;
};

/// Where the electrons of all cascades of a library stop: the channels BSE, of primaries (rule `reflected`), and
/// SE, of all others (rule `counted`), per primary. 0 is where the primaries start. Throws InvalidInput for an
/// empty library, UsageError for options out of range.
StoppingPointParameters stopping_points(const CascadeLibrary& library, const CascadeTableOptions& options = {});

}  // namespace surf::mc
