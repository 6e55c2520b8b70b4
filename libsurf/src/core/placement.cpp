// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/placement.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

void validate_pitch(double pitch_nm, char axis, const char* subject) {
  if (pitch_nm >= 1 / largest_raster_number && pitch_nm <= largest_raster_number) return;
  throw InvalidInput(subject, fmt::format("the pitch along {} is {} nm", axis, pitch_nm),
                     "The distance of neighbouring samples must be above 0, from 1e-60 to 1e60 nm");
}

}  // namespace

void validate(const Pitch& pitch, const char* subject) {
  validate_pitch(pitch.pitch_x_nm, 'x', subject);
  validate_pitch(pitch.pitch_y_nm, 'y', subject);
}

void validate(const Placement& placement, const char* subject) {
  validate(placement.pitch(), subject);
  if (std::abs(placement.origin_x_nm) <= largest_raster_number &&
      std::abs(placement.origin_y_nm) <= largest_raster_number)
    return;
  throw InvalidInput(
      subject,
      fmt::format("the origin is ({}, {}) nm", placement.origin_x_nm, placement.origin_y_nm),
      "Both coordinates must be finite and at most 1e60 nm from 0");
}

}  // namespace surf
