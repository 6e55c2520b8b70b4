// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "max_plus.h"
#include "surf/afm/morphology.h"

namespace surf::max_plus {

/// Heights as (top + z) quanta, with z as in max_plus.h.
struct Heights {
  Grid<Quanta> z;
  double top = 0;  ///< a whole number of quanta
};

/// The quantum for MorphologyOptions::quantum_nm. Throws InvalidInput if that is too fine.
double choose_quantum(const HeightField& surface, const Tip& tip, const MorphologyOptions& options);

/// The quantised surface, or its negative if `sign` is -1.
Heights quantise(const HeightField& surface, double sign, double quantum_nm);

/// Quantised tip samples, `unknown` where the tip has none. Samples that cannot meet a field of
/// this size are cut off.
struct TipQuanta {
  Grid<Quanta> z;
  int apex_x = 0, apex_y = 0;
};
TipQuanta quantise(const Tip& tip, double quantum_nm, int width, int height);

/// Converts to nm, with pitch and origin of `like`; unknown samples become holes.
HeightField to_field(const Heights& heights, double sign, double quantum_nm,
                     const HeightField& like);

/// Throws InvalidInput if field and tip cannot be used together.
void check_pair(const HeightField& field, const Tip& tip, const char* subject);

}  // namespace surf::max_plus
