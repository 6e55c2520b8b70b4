// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/parameters.h"

namespace surf::workflow {

/// How the yield of a pixel is estimated: from its own electrons, from those around it as well, or
/// with guides where that pays.
enum class Estimate { plain, guided, automatic };

struct EstimateOptions {
  Estimate kind = Estimate::plain;
  /// The fast model that guides: a file, "off", or "auto" for one of the cache that is of the
  /// scene's material, energy, spot and physics.
  std::string model = "auto";
};

/// The parameters simulation.estimate and simulation.guide_model.
void describe(ParameterVisitor& visit, EstimateOptions& options);

}  // namespace surf::workflow
