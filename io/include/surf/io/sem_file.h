// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/placed_image.h"

namespace surf::io {

struct SemReadOptions {
  std::string channel;  ///< by name, for files with several; empty: the first
  std::optional<double> pixel_x_nm, pixel_y_nm;  ///< override the size stated by the file; > 0
  bool keep_databar = false;                     ///< keep the strip of text below the image
};

/// An SEM image and the data that its microscope noted.
struct SemFile {
  /// Numbers as stored, such as 0 to 255. Coloured annotations and pixels without a number are
  /// invalid.
  PlacedImage image;
  std::string format;               ///< "Thermo/FEI", "Zeiss SmartSEM", "semsurf" ... or "image"
  std::string channel;              ///< of files with several
  int bits = 0;                     ///< of each number; 0: floats
  int databar_rows = 0;             ///< height of the strip of text below the image in the file
  std::string pixel_from;           ///< source of the pixel size: "Scan.PixelWidth", "given" ...
  std::optional<double> energy_ev;  ///< of the beam, > 0
  std::optional<double> working_distance_nm, tilt_deg;  ///< the tilt is the stage's tilt
  std::string detector, instrument;                     ///< empty if the file does not state them
  std::map<std::string, std::string> metadata;          ///< everything the file says about itself
  std::vector<std::string> notes;  ///< assumptions made and parts left out, for the user
};

/// Reads an image in any format that OpenImageIO reads. The pixel size is taken from the metadata
/// that Thermo/FEI, Zeiss, TESCAN, JEOL, Hitachi, ImageJ, OME-TIFF or semsurf have written into the
/// file or beside it: see docs/reference/sem_files.md. Row 0 of the file is the top. The lower-left
/// pixel lies at (0, 0), except in semsurf's own files, which state its place. Grey pictures stored
/// as RGB or with a palette become grey. Throws FileError; UsageError for an unknown channel, a
/// pixel size out of range, or if no pixel size is known; InvalidInput for pictures in colour and
/// fewer than 2 x 2 pixels.
SemFile read_sem_image(const std::filesystem::path& path, const SemReadOptions& options = {});

/// Whether the file, or a file beside it, bears the mark of a microscope's maker.
bool is_sem_image_file(const std::filesystem::path& path);

/// Throws InvalidInput if `is_sem_image_file`: grey levels are not heights. Do not call it if the
/// user has given the length of a grey level: that states that heights are wanted.
void refuse_as_heights(const std::filesystem::path& path);

}  // namespace surf::io
