// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/image_model.h"

#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

constexpr double pixel_tolerance = 1e-3;

bool alike(double a, double b) { return std::abs(a - b) <= pixel_tolerance * b; }

void check_number(double model, double wanted, const char* what, const char* unit) {
  if (wanted == 0 || alike(wanted, model)) return;
  throw UsageError("model",
                   fmt::format("it was made for {} of {} {}, the image is of {} {}", what,
                               format_exact(model), unit, format_exact(wanted), unit),
                   "Use a model made for these conditions, or train one: semsurf train");
}

}  // namespace

void check_field(const ModelScope& scope, const HeightField& field, const char* subject) {
  validate(field, subject);
  for (const unsigned char valid : field.valid.data())
    if (valid == 0)
      throw InvalidInput(subject, "it has samples without a height, and a model needs all of them",
                         "Fill them: semsurf clean");
  if (scope.pixel_nm == 0) return;
  const double x = field.pitch_x_nm, y = field.pitch_y_nm;
  if (alike(x, scope.pixel_nm) && alike(y, scope.pixel_nm)) return;
  const std::string model = format_exact(scope.pixel_nm);
  if (!alike(x, y))
    throw InvalidInput(
        subject,
        fmt::format("it is sampled every {} nm along x and every {} nm along y, the model was "
                    "made for {} nm along both",
                    format_exact(x), format_exact(y), model),
        "Resample the heights, or train a model for such samples on square ones");
  throw InvalidInput(
      subject,
      fmt::format("it is sampled every {} nm, the model was made for {} nm", format_exact(x),
                  model),
      fmt::format(
          "Resample the heights to {} nm (semsurf predict --resample), or train a model for {} nm",
          model, format_exact(x)));
}

void check_conditions(const ModelScope& scope, const ModelScope& wanted) {
  if (!scope.material.empty() && !wanted.material.empty() && scope.material != wanted.material)
    throw UsageError(
        "model",
        fmt::format("it was made for {}, the image is of {}", scope.material, wanted.material),
        "Use a model made for this material, or train one: semsurf train");
  if (scope.pixel_nm != 0) check_number(scope.pixel_nm, wanted.pixel_nm, "pixels", "nm");
  if (scope.energy_ev != 0) check_number(scope.energy_ev, wanted.energy_ev, "a beam", "eV");
  check_number(scope.spot_nm, wanted.spot_nm, "a spot", "nm");
}

}  // namespace surf
