// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/placed_image.h"

#include "raster.h"

namespace surf {

void validate(const PlacedImage& image, const char* subject) {
  validate_raster(image, image.values, image.valid, {"An image", "value"}, subject);
}

}  // namespace surf
