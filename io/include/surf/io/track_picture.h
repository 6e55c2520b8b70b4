// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surf/core/track.h"

namespace surf::io {

struct TrackPictureOptions {
  std::string title;     ///< above the picture; empty: none
  std::string subtitle;  ///< smaller, below the title: beam, material ...
  int width_px = 1600;   ///< 200 to 20000; PDF and SVG have 96 px per inch
  int height_px = 1200;  ///< 200 to 20000, likewise

  /// The specimen's cross-section as straight pieces in nm, drawn at their x and z; y is ignored.
  std::vector<std::array<Vec3, 2>> outline_nm;

  /// The part that is shown, in nm. By default it holds the paths inside matter with a margin,
  /// which is wider above, where the beam and escaping electrons are. Both axes have one scale; the
  /// window is widened if that leaves room.
  struct Window {
    double x0_nm, z0_nm, x1_nm, z1_nm;
  };
  std::optional<Window> window_nm;
};

/// Draws electron tracks from the side, x to the right and z up, in the format of the extension:
/// .png, .svg or .pdf. Colours show how a track ended and can be told apart by colour-blind readers
/// (Okabe and Ito 2008); a legend counts the tracks. The more tracks there are, the thinner and
/// more transparent are the lines; 20 to some thousand tracks look well. Text is set in DejaVu
/// Sans, else in a font of the system. The file appears under its name only when it is complete.
/// Throws UsageError for an unknown extension, InvalidInput for an invalid track, size or window or
/// if there is nothing to show, FileError.
void write_track_picture(const std::filesystem::path& path, std::span<const Track> tracks,
                         const TrackPictureOptions& options = {});

/// Throws what `write_track_picture` would throw for the name or folder, before any work is spent.
void check_track_picture_target(const std::filesystem::path& path);

}  // namespace surf::io
