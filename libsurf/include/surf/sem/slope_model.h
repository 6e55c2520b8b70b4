// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/sem/filter_bank.h"
#include "surf/sem/image_model.h"

namespace surf {

/// Brightness as a function of the angle theta between beam and surface normal, relative to the
/// brightness at theta = 0.
enum class SlopeForm {
  secant,               ///< sec theta (Jones 1994)
  ikeuchi_exponential,  ///< exp(a (1 - cos theta)), a = 1 (Ikeuchi 1981, thesis 2.2.4.1)
  ikeuchi_secant,       ///< sec(k theta), k = 0.8
  ikeuchi_mixed,        ///< (1 - s) + s sec theta, s = 0.5, constant beyond 70 degrees
  table,                ///< piecewise linear in theta (thesis, appendix E.1)
};

/// A channel of a slope model.
struct SlopeChannel {
  std::string name;
  /// Yield of a surface perpendicular to the beam, > 0; not used by a table.
  double flat_yield = 1;
  std::vector<double> yields;  ///< of a table: at the angles 0, step, 2 step ...; at least two
};

struct SlopeModelParameters {
  SlopeForm form = SlopeForm::secant;
  /// Step of the table's angles; the last line is extrapolated beyond the last angle.
  double table_step_deg = 5;
  FacetScale facet{5, 0.6};            ///< neighbourhood in which the slope is measured
  std::vector<SlopeChannel> channels;  ///< 1 to 8
};

/// Throws InvalidInput for parameters out of range.
std::shared_ptr<const ImageModel> make_slope_model(const ModelScope& scope,
                                                   const SlopeModelParameters& parameters);

}  // namespace surf
