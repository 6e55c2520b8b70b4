// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/height_field.h"

#include "raster.h"

namespace surf {

void validate(const HeightField& field, const char* subject) {
  validate_raster(field, field.z_nm, field.valid, {"A surface", "height"}, subject);
}

}  // namespace surf
