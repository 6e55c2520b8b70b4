// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/grid.h"

namespace surf {

/// One named quantity of an image.
struct Channel {
  std::string name;  ///< "SE", "SE.stderr", "BSE", "valid" ...
  std::string unit;  ///< "1" for counts per primary, "nm" ...
  Grid<float> values;
};

/// Named float channels of one size. Pixel (0, 0) is the lower-left one.
struct Image {
  std::vector<Channel> channels;  ///< one size; unique names
  double pitch_x_nm = 1;          ///< pixel width, > 0
  double pitch_y_nm = 1;          ///< pixel height, > 0
  double origin_x_nm = 0;         ///< centre of pixel (0, 0)
  double origin_y_nm = 0;
  /// Provenance and settings, written into every file that can hold text. Keys are lower case
  /// with dots ("semsurf.version", "beam.energy_ev"); nothing here depends on threads or clocks.
  std::map<std::string, std::string> metadata;

  int width() const { return channels.empty() ? 0 : channels.front().values.width(); }
  int height() const { return channels.empty() ? 0 : channels.front().values.height(); }

  /// The channel of that name, or nullptr.
  const Channel* find(std::string_view name) const;
};

/// Throws InvalidInput (naming `subject`) if there is no channel, a size differs, a name is empty
/// or used twice, or a pitch is not positive and finite.
void validate(const Image& image, const char* subject = "image");

}  // namespace surf
