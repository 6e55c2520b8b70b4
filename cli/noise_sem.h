// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "bound_parameters.h"

namespace surf::cli {

/// `semsurf noise sem`: the noise of one SEM image.
struct SemNoiseInput {
  std::string image;  ///< FILE or FILE:CHANNEL
  std::vector<std::string> regions;
};
/// noise.image and noise.flat_region.
void describe(ParameterVisitor& visit, SemNoiseInput& input);

/// All that it reads but the image and its pixel size. A `group` of "" hides them.
void add_sem_noise_options(CLI::App& app, BoundParameters& bound, const std::string& group);

int print_sem_noise(const GivenTexts& given, const std::optional<std::string>& plot, bool quiet);

}  // namespace surf::cli
