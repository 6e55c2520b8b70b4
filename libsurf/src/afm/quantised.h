// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "max_plus.h"
#include "surf/afm/morphology.h"

namespace surf::max_plus {

/// Heights as (top + z) quanta, z as max_plus.h has them.
struct Heights {
  Grid<Quanta> z;
  double top = 0;  ///< a whole number of quanta
};

/// What MorphologyOptions::quantum_nm says.
/// Throws InvalidInput where that is too fine.
double choose_quantum(const HeightField& surface, const Tip& tip, const MorphologyOptions& options);

/// The surface, or with `sign` -1 its negative.
Heights quantise(const HeightField& surface, double sign, double quantum_nm);

/// Tip samples, `unknown` where it has none; cut to those that can meet a field of this size.
struct TipQuanta {
  Grid<Quanta> z;
  int apex_x = 0, apex_y = 0;
};
TipQuanta quantise(const Tip& tip, double quantum_nm, int width, int height);

/// Back to nm with pitch and origin of `like`; unknown samples are holes.
HeightField to_field(const Heights& heights, double sign, double quantum_nm,
                     const HeightField& like);

/// Throws InvalidInput if they cannot be used together.
void check_pair(const HeightField& field, const Tip& tip, const char* subject);

}  // namespace surf::max_plus
