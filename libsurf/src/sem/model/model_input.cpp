// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "surf/core/all_within.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

// In pixels, and nm/pixel^2: the squares of curvatures fit into float.
constexpr double most_span = 1e12;

/// The largest less the smallest of some finite values. Eight at once, because a comparison waits
/// for the one before.
double span_of(const std::vector<double>& values) {
  constexpr std::size_t lanes = 8;
  double low[lanes], high[lanes];
  std::fill_n(low, lanes, values[0]);
  std::fill_n(high, lanes, values[0]);
  std::size_t i = 0;
  for (; i + lanes <= values.size(); i += lanes)
    for (std::size_t j = 0; j < lanes; ++j) {
      const double v = values[i + j];
      low[j] = v < low[j] ? v : low[j];
      high[j] = v > high[j] ? v : high[j];
    }
  for (; i < values.size(); ++i) {
    low[0] = std::min(low[0], values[i]);
    high[0] = std::max(high[0], values[i]);
  }
  return *std::max_element(high, high + lanes) - *std::min_element(low, low + lanes);
}

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
  const double pitch = std::min(field.pitch_x_nm, field.pitch_y_nm);
  const double span = span_of(field.z_nm.data()) / pitch;
  if (span <= most_span && span / pitch <= most_span) return;
  throw InvalidInput("height field",
                     fmt::format("spans {} nm at samples {} nm apart", format_exact(span * pitch),
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

void check_images(const ModelImages& images, const std::vector<std::string>& channels) {
  for (std::size_t c = 0; c < images.size(); ++c)
    if (!all_within(images[c].data(), std::numeric_limits<double>::max()))
      throw InvalidInput("image model",
                         fmt::format("its image of {} is not finite: its numbers are too large for "
                                     "these heights",
                                     channels[c]),
                         "Train it again, or check the unit of the heights");
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
