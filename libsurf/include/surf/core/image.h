// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/placement.h"

namespace surf {

/// One named quantity of an image.
struct Channel {
  std::string name;  ///< "SE", "SE.stderr", "BSE", "valid" ...
  std::string unit;  ///< "1" for counts per primary, "nm" ...
  Grid<float> values;
};

/// Named float channels of one size. Pixel (0, 0) is the lower-left pixel.
struct Image : Placement {
  std::vector<Channel> channels;  ///< all of the same size, with unique names
  /// Provenance and settings, written into every file format that can hold text. Keys are lower
  /// case with dots ("semsurf.version", "beam.energy_ev"). Values do not depend on threads or
  /// clocks.
  std::map<std::string, std::string> metadata;

  int width() const { return channels.empty() ? 0 : channels.front().values.width(); }
  int height() const { return channels.empty() ? 0 : channels.front().values.height(); }

  /// The channel called `name`, or nullptr.
  const Channel* find(std::string_view name) const;
};

/// Throws InvalidInput (naming `subject`) if there is no channel, sizes differ, a name is empty or
/// used twice, or the placement is invalid.
void validate(const Image& image, const char* subject = "image");

}  // namespace surf
