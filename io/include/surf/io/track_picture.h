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
  int width_px = 1600;   ///< 200 to 20000; PDF and SVG take 96 px for an inch
  int height_px = 1200;  ///< the same

  /// The specimen's section: straight pieces in nm, drawn where their x and z lie; y is ignored.
  std::vector<std::array<Vec3, 2>> outline_nm;

  /// What is shown, in nm. By default the paths inside matter with some space around them, and more
  /// of it above, where beam and escaping electrons are seen. Widened where the axes, which have
  /// one scale, leave room.
  struct Window {
    double x0_nm, z0_nm, x1_nm, z1_nm;
  };
  std::optional<Window> window_nm;
};

/// Draws electron tracks from the side, x to the right and z up, by extension: .png, .svg or .pdf.
/// Colours say how a track ended and can be told apart by the colour-blind (Okabe and Ito 2008);
/// a legend counts them. Lines are the thinner and the more transparent the more there are; 20 to
/// some thousand tracks look well. Text is set in DejaVu Sans, else in whatever the system has.
/// The file appears under its name only when it is complete.
/// Throws UsageError for an unknown extension, InvalidInput for an invalid track, size or window
/// or where there is nothing to show, FileError.
void write_track_picture(const std::filesystem::path& path, std::span<const Track> tracks,
                         const TrackPictureOptions& options = {});

/// Throws what `write_track_picture` would for the name or folder, before any work is spent.
void check_track_picture_target(const std::filesystem::path& path);

}  // namespace surf::io
