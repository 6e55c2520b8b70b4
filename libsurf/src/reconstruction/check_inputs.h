// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// Throws InvalidInput for data that no reconstruction can be made of, UsageError for options out
/// of range.
void check_inputs(const AfmData* afm, const SemData* sem, const std::vector<SemView>& views,
                  const ReconstructionOptions& options);

}  // namespace surf::reconstruction
