// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/registration/find_shift.h"

#include <algorithm>

#include "registration/shift_search.h"
#include "surf/core/error.h"

namespace surf {
namespace {

MaskedGrid masked(const PlacedImage& image) {
  return sampled(
      image.values.width(), image.values.height(), [&](int x, int y) { return image.values(x, y); },
      [&](int x, int y) { return image.is_valid(x, y); });
}

}  // namespace

std::vector<ImageShift> find_shifts(const PlacedImage& resting, const PlacedImage& moving,
                                    int count, double least_overlap) {
  validate(resting, "resting image"), validate(moving, "moving image");
  constexpr double same = 0.02;
  if (std::abs(resting.pitch_x_nm / moving.pitch_x_nm - 1) > same ||
      std::abs(resting.pitch_y_nm / moving.pitch_y_nm - 1) > same)
    throw InvalidInput("images", "their pixels differ in size", "Resample one of them");
  const ShiftSearch search(masked(resting), least_overlap,
                           {{moving.values.width(), moving.values.height()}});
  std::vector<ImageShift> out;
  for (const ShiftPeak& peak :
       search.peaks(masked(moving), static_cast<std::size_t>(std::max(count, 1))))
    out.push_back({resting.x_nm(peak.x) - moving.origin_x_nm,
                   resting.y_nm(peak.y) - moving.origin_y_nm, peak.correlation});
  return out;
}

}  // namespace surf
