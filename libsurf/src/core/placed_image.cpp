// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/placed_image.h"

#include "surf/core/height_field.h"

namespace surf {

void validate(const PlacedImage& image, const char* subject) {
  validate(HeightField{image.values, image.valid, image.pitch_x_nm, image.pitch_y_nm,
                       image.origin_x_nm, image.origin_y_nm},
           subject);
}

}  // namespace surf
