// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_input.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

// In pixels, and nm/pixel^2: the squares of curvatures fit into float.
constexpr double most_span = 1e12;

void check_finite(const Grid<double>& values, const Grid<double>& z_nm, const char* subject) {
  if (values.width() != z_nm.width() || values.height() != z_nm.height())
    throw InvalidInput(subject,
                       fmt::format("it has {} x {} pixels, the heights have {} x {}",
                                   values.width(), values.height(), z_nm.width(), z_nm.height()),
                       "Give one value for each sample");
  for (const double value : values.data())
    if (!std::isfinite(value))
      throw InvalidInput(subject, fmt::format("it holds {}", value), "All values must be finite");
}

}  // namespace

void check_span(const HeightField& field) {
  const auto [low, high] = std::minmax_element(field.z_nm.data().begin(), field.z_nm.data().end());
  const double pitch = std::min(field.pitch_x_nm, field.pitch_y_nm), span = (*high - *low) / pitch;
  if (span <= most_span && span / pitch <= most_span) return;
  throw InvalidInput("height field",
                     fmt::format("spans {} nm at samples {} nm apart", format_exact(*high - *low),
                                 format_exact(pitch)),
                     "No image model holds for that: check the units of the heights");
}

void check_weights(const ModelImages& weights, std::size_t channels, const Grid<double>& z_nm) {
  if (weights.size() != channels)
    throw InvalidInput(
        "weights",
        fmt::format("there are {} images, the model has {} channels", weights.size(), channels),
        "Give one image for each channel");
  for (const Grid<double>& image : weights) check_finite(image, z_nm, "weights");
}

void check_change(const Grid<double>& dz_nm, const Grid<double>& z_nm) {
  check_finite(dz_nm, z_nm, "change of the heights");
}

double magnitude(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most == 0 ? 0 : std::ldexp(1.0, std::clamp(std::ilogb(most), -1000, 1000));
}

void check_channels(const std::vector<std::string>& names, const char* subject) {
  if (names.empty() || names.size() > 8)
    throw InvalidInput(subject, fmt::format("it has {} channels", names.size()), "Give 1 to 8");
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) throw InvalidInput(subject, "it has a channel without a name", "Name it");
    if (!seen.insert(name).second)
      throw InvalidInput(subject, fmt::format("it has two channels \"{}\"", name),
                         "Give each its own name");
  }
}

}  // namespace surf
