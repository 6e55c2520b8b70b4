// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/shapes.h"

namespace surf {

/// A field of heights 0 of the extent's size, centred on (0, 0).
HeightField flat_field(const FieldExtent& extent);

}  // namespace surf
