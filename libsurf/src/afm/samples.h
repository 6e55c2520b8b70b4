// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

/// Throws InvalidInput unless the field is valid and the mask is empty or of the field's size.
inline void require_field(const HeightField& field, const Mask& use) {
  validate(field);
  if (use.empty() || (use.width() == field.z_nm.width() && use.height() == field.z_nm.height()))
    return;
  throw InvalidInput("mask",
                     fmt::format("it has {} x {} samples, the heights {} x {}", use.width(),
                                 use.height(), field.z_nm.width(), field.z_nm.height()),
                     "Give a mask of the same size");
}

inline bool is_used(const HeightField& field, const Mask& use, int x, int y) {
  return field.is_valid(x, y) && use.includes(x, y);
}

}  // namespace surf
