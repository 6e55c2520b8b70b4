// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>

#include "surf/sem/image_model.h"

namespace surf::bench {

/// Samples the exact posterior of a small case, and prints how the linearised one differs. Returns
/// the exit code: 0.
int compare_with_sampler(const std::shared_ptr<const ImageModel>& model, std::uint64_t seed);

}  // namespace surf::bench
