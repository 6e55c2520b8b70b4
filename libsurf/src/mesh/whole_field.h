// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/height_field.h"

namespace surf {

/// Throws InvalidInput on a damaged field or one with an invalid sample, Unsupported where samples
/// are too many to be numbered.
void require_no_holes(const HeightField& field);

}  // namespace surf
