// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/image.h"

namespace surf::workflow {

/// Whether a place lies under the image, whose pixels reach half a pitch beyond their centres.
bool covers(const Image& image, double x_nm, double y_nm);

/// "x 0 to 500, y 0 to 300 nm".
std::string place_of(const Image& image);

/// A channel's values anywhere, between pixels in proportion to the four around; NaN beyond the
/// image, where it is not valid and beside holes. The image must outlive it.
class ImageSampler {
 public:
  ImageSampler(const Image& image, const std::string& channel);
  float at(double x_nm, double y_nm) const;

 private:
  double pixel(int x, int y) const;

  const Image& image_;
  const Grid<float>& values_;
  const Channel* valid_;
};

}  // namespace surf::workflow
