// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/height_field.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "surf/core/all_within.h"
#include "surf/core/error.h"

namespace surf {
namespace {

void validate_pitch(double pitch_nm, char axis, const char* subject) {
  if (std::isfinite(pitch_nm) && pitch_nm > 0) return;
  throw InvalidInput(subject, fmt::format("the pitch along {} is {} nm", axis, pitch_nm),
                     "The distance of neighbouring samples must be finite and above 0");
}

}  // namespace

void validate(const HeightField& field, const char* subject) {
  const Grid<double>& z = field.z_nm;
  if (z.width() < 2 || z.height() < 2) {
    throw InvalidInput(subject, fmt::format("it has {} x {} samples", z.width(), z.height()),
                       "A surface needs at least 2 x 2");
  }
  validate_pitch(field.pitch_x_nm, 'x', subject);
  validate_pitch(field.pitch_y_nm, 'y', subject);
  if (!std::isfinite(field.origin_x_nm) || !std::isfinite(field.origin_y_nm)) {
    throw InvalidInput(
        subject, fmt::format("the origin is ({}, {}) nm", field.origin_x_nm, field.origin_y_nm),
        "Both coordinates must be finite");
  }
  const Grid<unsigned char>& mask = field.valid;
  if (!mask.empty() && (mask.width() != z.width() || mask.height() != z.height())) {
    throw InvalidInput(subject,
                       fmt::format("its mask has {} x {} samples, its heights {} x {}",
                                   mask.width(), mask.height(), z.width(), z.height()),
                       "Give a mask of the same size, or none");
  }
  if (all_within(z.data(), std::numeric_limits<double>::max())) return;
  for (int row = 0; row < z.height(); ++row) {
    for (int column = 0; column < z.width(); ++column) {
      if (!field.is_valid(column, row) || std::isfinite(z(column, row))) continue;
      throw InvalidInput(
          subject,
          fmt::format("the height at column {}, row {} is {}", column, row, z(column, row)),
          "Fill the sample or mark it as invalid");
    }
  }
}

}  // namespace surf
