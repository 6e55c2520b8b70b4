// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/shapes.h"

namespace surf {

/// A flat field of the given extent: all heights are 0, centred on (0, 0).
HeightField flat_field(const FieldExtent& extent);

}  // namespace surf
