// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/sem/filter_bank.h"
#include "surf/sem/image_model.h"

namespace surf {

/// Brightness as a function of the angle theta between beam and surface normal, relative to theta =
/// 0.
enum class SlopeForm {
  secant,               ///< sec theta (Jones 1994)
  ikeuchi_exponential,  ///< exp(a (1 - cos theta)), a = 1 (Ikeuchi 1981, thesis 2.2.4.1)
  ikeuchi_secant,       ///< sec(k theta), k = 0.8
  ikeuchi_mixed,        ///< (1 - s) + s sec theta, s = 0.5, held at its value at 70 degrees beyond
  table,                ///< piecewise linear in theta (thesis, appendix E.1)
};

/// A channel of a slope model.
struct SlopeChannel {
  std::string name;
  double flat_yield = 1;       ///< what a surface across the beam gives, > 0; not used by a table
  std::vector<double> yields;  ///< of a table: at 0, step, 2 step ...; at least two
};

struct SlopeModelParameters {
  SlopeForm form = SlopeForm::secant;
  double table_step_deg = 5;  ///< of the table's angles; beyond the last one its last line goes on
  FacetScale facet{5, 0.6};   ///< the neighbourhood that the slope is measured in
  std::vector<SlopeChannel> channels;  ///< 1 to 8
};

/// Throws InvalidInput for parameters out of range.
std::shared_ptr<const ImageModel> make_slope_model(const ModelScope& scope,
                                                   const SlopeModelParameters& parameters);

}  // namespace surf
