// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/height_field.h"

namespace surf {

/// Throws InvalidInput for a damaged field or one with an invalid sample, Unsupported if there are
/// too many samples for 32-bit numbers.
void require_no_holes(const HeightField& field);

}  // namespace surf
