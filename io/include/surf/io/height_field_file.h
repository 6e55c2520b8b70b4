// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/height_field.h"

namespace surf::io {

/// A height channel of a file.
struct HeightChannel {
  std::string name;          ///< as the file calls it
  std::string z_unit;        ///< as the file calls it; empty where it says nothing
  int width = 0, height = 0;
};

struct HeightReadOptions {
  std::string channel;                  ///< by name, or by its number from 1; empty: the first of heights
  std::optional<double> z_unit_nm;      ///< of files that do not say: default 1
  std::optional<double> pitch_x_nm, pitch_y_nm;   ///< of files that do not say: default 1
};

/// What a scan file holds of one channel.
struct HeightFieldFile {
  HeightField field;
  std::string channel;
  std::string format;                           ///< "Gwyddion", "Bruker Nanoscope" ...
  std::map<std::string, std::string> metadata;  ///< what the file says of itself; of ours, what made it
  std::vector<std::string> notes;               ///< what had to be assumed, for the user
};

/// Reads a height image by content, then by name.
HeightFieldFile read_height_field(const std::filesystem::path& path,
                                  const HeightReadOptions& options = {});

/// All height channels of a file, in its order.
std::vector<HeightChannel> height_channels(const std::filesystem::path& path);

/// Writes by extension: GSF (32-bit floats), TIFF (32-bit floats, nm), text, VTI.
void write_height_field(const std::filesystem::path& path, const HeightField& field,
                        const std::map<std::string, std::string>& metadata = {});

/// Throws what `write_height_field` would for the name or folder, before any work is spent.
void check_height_field_target(const std::filesystem::path& path);

}  // namespace surf::io
